"""Culbuto: two-dimensional physics in double precision that says how wrong it is.

Quantities are in SI units, angles in radians, y points up. Wherever a vector is wanted a tuple of
two numbers will do; vectors come back as `Vec2`:

>>> import culbuto as cb
>>> velocity = cb.Vec2(3, 4)
>>> velocity.length
5.0
>>> velocity + (1, 0)
Vec2(4.0, 4.0)
>>> x, y = velocity
>>> velocity == (x, y)
True

A world holds bodies, joints, fields of force and schedules, and moves them:

>>> world = cb.World(gravity=(0, -9.81))
>>> ball = world.add_body(cb.Circle(0.1), velocity=(12, 9))
>>> world.step(1 / 60, steps=120)
>>> round(ball.position.x, 12), round(ball.position.y, 12)
(24.0, -1.62)
>>> world.positions.shape
(1, 2)
>>> report = world.advance(1.0, tolerance=1e-9)  # a second to a stated error
>>> report.estimate
0.0
>>> pull = world.add_field(lambda state: -0.5 * state.positions, name="pull")
>>> world.step(1 / 60)

`SceneFile`, `World.from_file` and `World.save` read and write worlds as JSON.

A bad number or shape is a `ValueError`; what was removed from its world, a `StaleHandleError`; a
motion that cannot go on, a `SimulationError`.
"""

from culbuto import builders
from culbuto._native import (
    Arc,
    Attraction,
    Body,
    Box,
    BrokenJoint,
    Capsule,
    Central,
    Chain,
    Circle,
    Contact,
    ContactEvent,
    ContactEvents,
    Contacts,
    Distance,
    Energy,
    Events,
    Facts,
    Field,
    Fluid,
    Frame,
    Inflow,
    Joints,
    MassProperties,
    Nearest,
    NearestSoft,
    Oscillating,
    PairOfMaterials,
    Polygon,
    PreSolve,
    RayHit,
    RayHits,
    RegularPolygon,
    RoundedPolygon,
    SceneFile,
    SceneFileError,
    Schedule,
    Segment,
    Shape,
    SimulationError,
    Snapshot,
    SoftBody,
    SoftContact,
    SoftEvents,
    SoftRayHit,
    SpringMotion,
    StaleHandleError,
    State,
    Stepper,
    StepReport,
    Trajectory,
    Vec2,
    World,
    __version__,
    methods,
    scene_schema,
)
from culbuto.audit import Audit
from culbuto.catalogue import Laws, Limits, Scene, Verdict, scene, scenes, verify, verify_laws
from culbuto.joints import (
    AngleSpringJoint,
    CustomJoint,
    DistanceJoint,
    FilterJoint,
    FrictionJoint,
    GearJoint,
    GrabJoint,
    Joint,
    MotorJoint,
    PrismaticJoint,
    PulleyJoint,
    RackJoint,
    RatchetJoint,
    RevoluteJoint,
    RopeJoint,
    WeldJoint,
    WheelJoint,
)
from culbuto.study import Row, Study, study

__all__ = [
    "AngleSpringJoint",
    "Arc",
    "Attraction",
    "Audit",
    "Body",
    "Box",
    "BrokenJoint",
    "Capsule",
    "Central",
    "Chain",
    "Circle",
    "Contact",
    "ContactEvent",
    "ContactEvents",
    "Contacts",
    "CustomJoint",
    "Distance",
    "DistanceJoint",
    "Energy",
    "Events",
    "Facts",
    "Field",
    "FilterJoint",
    "Fluid",
    "Frame",
    "FrictionJoint",
    "GearJoint",
    "GrabJoint",
    "Inflow",
    "Joint",
    "Joints",
    "Laws",
    "Limits",
    "MassProperties",
    "MotorJoint",
    "Nearest",
    "NearestSoft",
    "Oscillating",
    "PairOfMaterials",
    "Polygon",
    "PreSolve",
    "PrismaticJoint",
    "PulleyJoint",
    "RackJoint",
    "RatchetJoint",
    "RayHit",
    "RayHits",
    "RegularPolygon",
    "RevoluteJoint",
    "RopeJoint",
    "RoundedPolygon",
    "Row",
    "Scene",
    "SceneFile",
    "SceneFileError",
    "Schedule",
    "Segment",
    "Shape",
    "SimulationError",
    "Snapshot",
    "SoftBody",
    "SoftContact",
    "SoftEvents",
    "SoftRayHit",
    "SpringMotion",
    "StaleHandleError",
    "State",
    "StepReport",
    "Stepper",
    "Study",
    "Trajectory",
    "Vec2",
    "Verdict",
    "WeldJoint",
    "WheelJoint",
    "World",
    "__version__",
    "builders",
    "methods",
    "scene",
    "scene_schema",
    "scenes",
    "study",
    "verify",
    "verify_laws",
]
