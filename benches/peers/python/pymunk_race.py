"""Pymunk's side of the race. Not for use by hand: the runner starts it, see `make peers`."""

from __future__ import annotations

import math
import time
from typing import Any

import pymunk
from orders import obey, pushes

KINDS = {
    "static": pymunk.Body.STATIC,
    "kinematic": pymunk.Body.KINEMATIC,
    "dynamic": pymunk.Body.DYNAMIC,
}
TIME_TO_SLEEP = 0.5  # s, as the other engines
SLOP = 1e-3  # of the usual length: its default, 0.1, is meant for pixels


def make_shape(body: pymunk.Body, declared: dict[str, Any]) -> pymunk.Shape:
    """One convex shape of a body, without a rounding radius."""
    [(kind, given)] = declared.items()
    if kind == "circle":
        return pymunk.Circle(body, given["radius"], tuple(given["center"]))
    if kind in {"segment", "capsule"}:
        radius = given.get("radius", 0.0)
        return pymunk.Segment(body, tuple(given["a"]), tuple(given["b"]), radius)
    if kind == "polygon":
        return pymunk.Poly(body, [tuple(corner) for corner in given["vertices"]])
    (x, y), (w, h) = given["center"], given["half"]
    return pymunk.Poly(body, [(x - w, y - h), (x + w, y - h), (x + w, y + h), (x - w, y + h)])


class Race:
    """A scene, and its world."""

    def __init__(self, scene: dict[str, Any]) -> None:
        """Makes the world; pymunk's other defaults stay."""
        self.swing: dict[str, Any] | None = scene["swing"]
        self.space = pymunk.Space()
        self.space.gravity = tuple(scene["gravity"])
        self.space.iterations = scene["iterations"]
        if scene["size"] is not None:
            self.space.collision_slop = SLOP * scene["size"]
        if scene["sleeping"]:
            self.space.sleep_time_threshold = TIME_TO_SLEEP
        self.bodies = [self.make_body(declared, scene) for declared in scene["bodies"]]
        for declared in scene["joints"]:
            self.make_joint(declared)

    def make_body(self, declared: dict[str, Any], scene: dict[str, Any]) -> pymunk.Body:
        """One body with its shapes; mass, centre and moment follow from the density."""
        body = pymunk.Body(body_type=KINDS[declared["kind"]])
        shapes = [make_shape(body, shape) for shape in declared["shapes"]]
        for shape in shapes:
            if declared["kind"] == "dynamic":
                shape.density = declared["density"]
            # Those of two shapes are multiplied.
            shape.friction = math.sqrt(scene["friction"])
            shape.elasticity = math.sqrt(scene["restitution"])
            shape.filter = pymunk.ShapeFilter(group=declared["group"])
        body.position = tuple(declared["position"])
        body.angle = declared["angle"]
        self.space.add(body, *shapes)
        if declared["kind"] != "static":
            body.velocity = tuple(declared["velocity"])
            body.angular_velocity = declared["angular_velocity"]
        if declared["asleep"] and scene["sleeping"]:
            body.sleep()
        return body

    def make_joint(self, declared: dict[str, Any]) -> None:
        """A rod or its spring; a hinge, its limits and its spring each a constraint."""
        a, b = (self.bodies[k] for k in declared["bodies"])
        ends = [tuple(anchor) for anchor in declared["anchors"]]
        length, spring = declared["distance"], declared["spring"]
        if length is not None:
            part: pymunk.Constraint = pymunk.PinJoint(a, b, *ends)
            if spring is not None:
                constants = (spring["stiffness"], spring["damping"])
                part = pymunk.DampedSpring(a, b, *ends, length, *constants)
            part.collide_bodies = False
            self.space.add(part)
            return
        parts: list[pymunk.Constraint] = [pymunk.PivotJoint(a, b, *ends)]
        if declared["limits"] is not None:
            parts.append(pymunk.RotaryLimitJoint(a, b, *declared["limits"]))
        if spring is not None:
            stiffness, damping = spring["stiffness"], spring["damping"]
            parts.append(pymunk.DampedRotarySpring(a, b, 0.0, stiffness, damping))
        for part in parts:
            part.collide_bodies = False
        self.space.add(*parts)

    def advance(self, first: int, last: int, dt: float) -> float:
        """Takes steps and gives their CPU time (s)."""
        start = time.process_time()
        for step in range(first, last):
            if self.swing is not None:
                velocity = pushes(self.swing, step, dt)
                self.bodies[self.swing["body"]].velocity = velocity
            self.space.step(dt)
        return time.process_time() - start

    def state(self) -> list[dict[str, Any]]:
        """All bodies, in the scene's order."""
        return [
            {
                "position": tuple(body.position),
                "angle": body.angle,
                "velocity": tuple(body.velocity),
                "angular_velocity": body.angular_velocity,
            }
            for body in self.bodies
        ]


if __name__ == "__main__":
    obey(Race, f"pymunk {pymunk.version}")
