"""Box2D 2's side of the race (PyPI's box2d). Not for use by hand: the runner starts it.

Its constants are in metres and cannot be changed, so lengths are handed over in the scene's usual
length where there is one.
"""

from __future__ import annotations

import time
from importlib.metadata import version
from typing import Any

import Box2D as b2
from orders import obey, pushes

KINDS = {"static": b2.b2_staticBody, "kinematic": b2.b2_kinematicBody, "dynamic": b2.b2_dynamicBody}


class Race:
    """A scene, and its world."""

    def __init__(self, scene: dict[str, Any]) -> None:
        """Makes the world; other defaults stay."""
        self.unit: float = scene["size"] or 1.0
        self.swing: dict[str, Any] | None = scene["swing"]
        # Its manual takes 8 and 3.
        self.iterations = (scene["iterations"], max(1, round(scene["iterations"] * 3 / 8)))
        self.world = b2.b2World(gravity=self.pair(scene["gravity"]), doSleep=scene["sleeping"])
        self.bodies = [self.make_body(declared, scene) for declared in scene["bodies"]]
        for declared in scene["joints"]:
            self.make_joint(declared)

    def pair(self, vector: list[float]) -> tuple[float, float]:
        """A length or a velocity in its unit."""
        return (vector[0] / self.unit, vector[1] / self.unit)

    def shapes(self, declared: dict[str, Any]) -> list[Any]:
        """A convex shape; of a capsule, which it has not, a box and two disks."""
        [(kind, given)] = declared.items()
        if kind == "circle":
            disk = b2.b2CircleShape(pos=self.pair(given["center"]))
            disk.radius = given["radius"] / self.unit
            return [disk]
        if kind == "segment":
            ends = [self.pair(given["a"]), self.pair(given["b"])]
            return [b2.b2EdgeShape(vertices=ends)]
        if kind == "polygon":
            return [b2.b2PolygonShape(vertices=[self.pair(p) for p in given["vertices"]])]
        if kind == "capsule":
            return self.capsule(given)
        (x, y), (w, h) = self.pair(given["center"]), self.pair(given["half"])
        return [b2.b2PolygonShape(box=(w, h, (x, y), 0.0))]

    def capsule(self, given: dict[str, Any]) -> list[Any]:
        """Its box weighs as much as it has area; the disks weigh nothing."""
        a, b = b2.b2Vec2(*self.pair(given["a"])), b2.b2Vec2(*self.pair(given["b"]))
        radius = given["radius"] / self.unit
        along = b - a
        side = b2.b2Vec2(-along.y, along.x) * (radius / along.length)
        corners = [a - side, b - side, b + side, a + side]
        ends = [b2.b2CircleShape(pos=end, radius=radius) for end in (a, b)]
        return [b2.b2PolygonShape(vertices=[tuple(corner) for corner in corners]), *ends]

    def make_body(self, declared: dict[str, Any], scene: dict[str, Any]) -> b2.b2Body:
        """One body with its shapes; mass, centre and moment follow from the density."""
        body = self.world.CreateBody(
            type=KINDS[declared["kind"]],
            position=self.pair(declared["position"]),
            angle=declared["angle"],
            linearVelocity=self.pair(declared["velocity"]),
            angularVelocity=declared["angular_velocity"],
            awake=not (declared["asleep"] and scene["sleeping"]),
        )
        for shape in declared["shapes"]:
            for place, part in enumerate(self.shapes(shape)):
                body.CreateFixture(
                    shape=part,
                    density=declared["density"] * self.unit**2 if place == 0 else 0.0,
                    friction=scene["friction"],
                    restitution=scene["restitution"],
                    groupIndex=-declared["group"],
                )
        return body

    def make_joint(self, declared: dict[str, Any]) -> None:
        """A hinge, or a rod or its spring."""
        a, b = (self.bodies[k] for k in declared["bodies"])
        ends = [self.pair(anchor) for anchor in declared["anchors"]]
        given: dict[str, Any] = {
            "bodyA": a,
            "bodyB": b,
            "localAnchorA": ends[0],
            "localAnchorB": ends[1],
            "collideConnected": False,
        }
        length, spring = declared["distance"], declared["spring"]
        if length is None:
            if spring is not None or declared["limits"] is not None:
                message = "it has no hinge with a spring"
                raise ValueError(message)
            self.world.CreateRevoluteJoint(**given)
            return
        if spring is not None:
            given |= {"frequencyHz": spring["hertz"], "dampingRatio": spring["damping_ratio"]}
        self.world.CreateDistanceJoint(length=length / self.unit, **given)

    def advance(self, first: int, last: int, dt: float) -> float:
        """Takes steps and gives their CPU time (s)."""
        start = time.process_time()
        for step in range(first, last):
            if self.swing is not None:
                velocity = self.pair(list(pushes(self.swing, step, dt)))
                self.bodies[self.swing["body"]].linearVelocity = velocity
            self.world.Step(dt, *self.iterations)
        return time.process_time() - start

    def state(self) -> list[dict[str, Any]]:
        """All bodies, in the scene's order."""
        return [
            {
                "position": (body.position.x * self.unit, body.position.y * self.unit),
                "angle": body.angle,
                "velocity": (body.linearVelocity.x * self.unit, body.linearVelocity.y * self.unit),
                "angular_velocity": body.angularVelocity,
            }
            for body in self.bodies
        ]


if __name__ == "__main__":
    obey(Race, f"box2d {version('box2d')} (Python)")
