//! Adding, removing, reading and changing bodies.

use crate::body::{Bodies, BodyDef, BodyHandle, BodyKind, DragWidth, Info, Locks, Mass, Part};
use crate::body::{Filter, FilterOverride, Role, Surface, SurfaceOverride};
use crate::error::{Error, Result, check};
use crate::math::{Pose, Real, Twist, Vec2, Wrench, cross, vec2};
use crate::world::World;

impl World {
    /// Adds a body.
    ///
    /// # Errors
    /// [`crate::Error::Invalid`] names the number that is not allowed; the world stays as it was.
    pub fn add_body(&mut self, def: BodyDef) -> Result<BodyHandle> {
        let handle = self.state.bodies.insert(def)?;
        self.state.contacts.add(&self.state.bodies);
        let index = self.state.bodies.len() - 1;
        if !self.state.bodies.masses[index].is_free() {
            self.disturbed(index);
        }
        self.plan = None;
        Ok(handle)
    }

    /// Removes a body, the schedules on it and its joints. The last body takes its place in body order.
    pub fn remove_body(&mut self, body: BodyHandle) -> Result<()> {
        let index = self.state.bodies.index(body)?;
        self.disturbed(index);
        self.forget_strays(index);
        self.state.contacts.remove(&self.state.bodies, index);
        self.unjoin(body);
        self.state.bodies.remove(body)?;
        self.state.schedules.retain(|schedule| schedule.body != body);
        self.plan = None;
        Ok(())
    }

    /// A body, to read.
    pub fn body(&self, body: BodyHandle) -> Result<BodyRef<'_>> {
        let index = self.state.bodies.index(body)?;
        Ok(BodyRef {
            bodies: &self.state.bodies,
            asleep: self.state.contacts.is_asleep(index),
            index,
        })
    }

    /// A body, to change.
    pub fn body_mut(&mut self, body: BodyHandle) -> Result<BodyMut<'_>> {
        let index = self.state.bodies.index(body)?;
        Ok(BodyMut { world: self, index })
    }
}

/// A body, to read.
#[derive(Clone, Copy)]
pub struct BodyRef<'a> {
    bodies: &'a Bodies,
    asleep: bool,
    index: usize,
}

impl<'a> BodyRef<'a> {
    /// Place of the body in body order.
    #[must_use]
    pub fn index(&self) -> usize {
        self.index
    }

    /// Where the body's frame stands.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.bodies.origin(self.index)
    }

    /// Position of the body's frame (m).
    #[must_use]
    pub fn position(&self) -> Vec2 {
        self.pose().position
    }

    /// Position of the centre of mass (m).
    #[must_use]
    pub fn center_of_mass(&self) -> Vec2 {
        self.bodies.poses[self.index].position
    }

    /// Centre of mass in the body's frame (m).
    #[must_use]
    pub fn local_center(&self) -> Vec2 {
        self.bodies.local_centers[self.index]
    }

    /// Angle (rad), unwrapped.
    #[must_use]
    pub fn angle(&self) -> Real {
        self.bodies.poses[self.index].angle
    }

    /// Largest distance of the outline from the centre of mass (m).
    #[must_use]
    pub fn size(&self) -> Real {
        self.bodies.infos[self.index].size
    }

    /// Velocity of the centre of mass (m/s) and angular velocity (rad/s).
    #[must_use]
    pub fn twist(&self) -> Twist {
        self.bodies.twists[self.index]
    }

    /// Velocity of the centre of mass (m/s).
    #[must_use]
    pub fn velocity(&self) -> Vec2 {
        self.twist().linear
    }

    /// Angular velocity (rad/s).
    #[must_use]
    pub fn angular_velocity(&self) -> Real {
        self.twist().angular
    }

    /// Velocity (m/s) of the point of the body that is at a world point: v + ω × r.
    #[must_use]
    pub fn velocity_at(&self, point: Vec2) -> Vec2 {
        self.twist().at(point - self.center_of_mass())
    }

    /// A point in the body's frame, in world coordinates.
    #[must_use]
    pub fn world_point(&self, local: Vec2) -> Vec2 {
        self.pose().apply(local)
    }

    /// A world point in the body's frame.
    #[must_use]
    pub fn local_point(&self, world: Vec2) -> Vec2 {
        self.pose().apply_inverse(world)
    }

    /// Mass (kg) and inertia (kg·m²), and what of them answers to forces.
    #[must_use]
    pub fn mass(&self) -> &'a Mass {
        &self.bodies.masses[self.index]
    }

    /// Constant force (N) and torque (N·m).
    #[must_use]
    pub fn force(&self) -> Wrench {
        self.bodies.forces[self.index]
    }

    /// ½mv² + ½Iω² (J).
    #[must_use]
    pub fn kinetic_energy(&self) -> Real {
        self.mass().kinetic_energy(&self.twist())
    }

    /// Whether the body sleeps: it rests, and is left out of the work until something wakes it.
    #[must_use]
    pub fn is_asleep(&self) -> bool {
        self.asleep
    }

    /// Shapes, kind, locks, damping and the rest.
    #[must_use]
    pub fn info(&self) -> &'a Info {
        &self.bodies.infos[self.index]
    }

    /// The definition that makes this body as it is now.
    #[must_use]
    pub fn def(&self) -> BodyDef {
        self.bodies.def(self.index)
    }
}

/// A body, to change. Whatever is refused leaves the body as it was.
pub struct BodyMut<'a> {
    world: &'a mut World,
    index: usize,
}

impl BodyMut<'_> {
    fn bodies(&mut self) -> &mut Bodies {
        &mut self.world.state.bodies
    }

    /// Reads what was written.
    #[must_use]
    pub fn get(&self) -> BodyRef<'_> {
        let asleep = self.world.state.contacts.is_asleep(self.index);
        BodyRef { bodies: &self.world.state.bodies, asleep, index: self.index }
    }

    /// Puts the body's frame at a position (m).
    pub fn set_position(&mut self, position: Vec2) -> Result<()> {
        check::finite_vec("position", position)?;
        let (i, angle) = (self.index, self.get().angle());
        self.bodies().set_origin(i, Pose::new(position, angle));
        self.world.placed(i);
        Ok(())
    }

    /// Puts the centre of mass at a position (m); the frame goes with it.
    pub fn place_center_of_mass(&mut self, center: Vec2) -> Result<()> {
        check::finite_vec("center_at", center)?;
        let i = self.index;
        self.bodies().poses[i].position = center;
        self.world.placed(i);
        Ok(())
    }

    /// Turns the body's frame to an angle (rad); its position stays.
    pub fn set_angle(&mut self, angle: Real) -> Result<()> {
        check::finite("angle", angle)?;
        let (i, position) = (self.index, self.get().position());
        self.bodies().set_origin(i, Pose::new(position, angle));
        self.world.placed(i);
        Ok(())
    }

    /// Sets the velocity of the centre of mass (m/s) and the angular velocity (rad/s).
    pub fn set_twist(&mut self, twist: Twist) -> Result<()> {
        check::finite_vec("velocity", twist.linear)?;
        check::finite("angular_velocity", twist.angular)?;
        let i = self.index;
        self.bodies().infos[i].def.allows_velocity(twist.linear, twist.angular)?;
        self.world.pushed(i);
        self.bodies().twists[i] = twist;
        Ok(())
    }

    /// Sets the velocity of the centre of mass (m/s).
    pub fn set_velocity(&mut self, velocity: Vec2) -> Result<()> {
        let angular = self.get().angular_velocity();
        self.set_twist(Twist::new(velocity, angular))
    }

    /// Sets the angular velocity (rad/s).
    pub fn set_angular_velocity(&mut self, angular: Real) -> Result<()> {
        let linear = self.get().velocity();
        self.set_twist(Twist::new(linear, angular))
    }

    /// Sets the constant force (N) through the centre of mass and the constant torque (N·m).
    pub fn set_force(&mut self, wrench: Wrench) -> Result<()> {
        check::finite_vec("force", wrench.force)?;
        check::finite("torque", wrench.torque)?;
        let i = self.index;
        self.world.pushed(i);
        self.bodies().forces[i] = wrench;
        self.world.plan = None;
        Ok(())
    }

    /// Adds a force (N) for the next step, at a world point or through the centre of mass.
    pub fn apply_force(&mut self, force: Vec2, at: Option<Vec2>) -> Result<()> {
        check::finite_vec("force", force)?;
        let torque = self.torque_of(force, at)?;
        let i = self.index;
        self.world.pushed(i);
        self.bodies().applied[i] += Wrench::new(force, torque);
        self.world.applied = true;
        Ok(())
    }

    /// Adds a torque (N·m) for the next step.
    pub fn apply_torque(&mut self, torque: Real) -> Result<()> {
        check::finite("torque", torque)?;
        let i = self.index;
        self.world.pushed(i);
        self.bodies().applied[i].torque += torque;
        self.world.applied = true;
        Ok(())
    }

    /// Changes the velocities at once: Δv = P/m, Δω = (r × P)/I, for an impulse P (N·s) at a world
    /// point or through the centre of mass.
    pub fn apply_impulse(&mut self, impulse: Vec2, at: Option<Vec2>) -> Result<()> {
        check::finite_vec("impulse", impulse)?;
        let torque = self.torque_of(impulse, at)?;
        self.jolt(&Wrench::new(impulse, torque))
    }

    /// Changes the angular velocity at once: Δω = L/I, for an angular impulse L (N·m·s).
    pub fn apply_angular_impulse(&mut self, impulse: Real) -> Result<()> {
        check::finite("impulse", impulse)?;
        self.jolt(&Wrench::new(vec2(0.0, 0.0), impulse))
    }

    /// Wakes the body and the island that sleeps with it; one that is awake starts anew to be slow.
    pub fn wake(&mut self) {
        self.world.pushed(self.index);
    }

    /// Lets the body sleep together with all that it touched after the last step and that can move: they stop, and
    /// what that takes counts as dissipated. Nothing happens where sleeping is off or a field acts.
    pub fn sleep(&mut self) {
        self.world.lay_down(self.index);
    }

    fn torque_of(&self, force: Vec2, at: Option<Vec2>) -> Result<Real> {
        let Some(point) = at else { return Ok(0.0) };
        check::finite_vec("at", point)?;
        Ok(cross(point - self.get().center_of_mass(), force))
    }

    fn jolt(&mut self, impulse: &Wrench) -> Result<()> {
        let change = self.get().mass().acceleration(impulse);
        let twist = self.get().twist();
        self.set_twist(Twist::new(twist.linear + change.linear, twist.angular + change.angular))
    }

    fn edit(&mut self, edit: impl FnOnce(&mut BodyDef)) -> Result<()> {
        let i = self.index;
        self.world.disturbed(i);
        self.bodies().edit(i, edit)?;
        self.world.forget_strays(i);
        self.world.state.contacts.replace(&self.world.state.bodies, i);
        self.world.disturbed(i);
        self.world.plan = None;
        Ok(())
    }

    /// Sets the name.
    pub fn set_name(&mut self, name: Option<String>) -> Result<()> {
        self.edit(|def| def.name = name)
    }

    /// Makes the body static (which stops it), kinematic or dynamic.
    pub fn set_kind(&mut self, kind: BodyKind) -> Result<()> {
        self.edit(|def| {
            def.kind = kind;
            if kind == BodyKind::Static {
                (def.velocity, def.angular_velocity) = (vec2(0.0, 0.0), 0.0);
            }
        })
    }

    /// Locks axes; the velocity along a locked axis becomes 0.
    pub fn set_locks(&mut self, locks: Locks) -> Result<()> {
        self.edit(|def| {
            def.locks = locks;
            let dynamic = def.is_dynamic();
            let keep = |lock: bool, v: Real| if lock && dynamic { 0.0 } else { v };
            def.velocity = vec2(keep(locks.x, def.velocity.x), keep(locks.y, def.velocity.y));
            def.angular_velocity = keep(locks.rotation, def.angular_velocity);
        })
    }

    /// Sets the mass (kg); none: what follows from the densities. Velocities stay.
    pub fn set_mass(&mut self, mass: Option<Real>) -> Result<()> {
        self.edit(|def| def.mass = mass)
    }

    /// Sets the moment of inertia (kg·m²); none: what follows from shapes and mass.
    pub fn set_inertia(&mut self, inertia: Option<Real>) -> Result<()> {
        self.edit(|def| def.inertia = inertia)
    }

    /// Sets the density of shapes that have none of their own.
    pub fn set_density(&mut self, density: Real) -> Result<()> {
        self.edit(|def| def.density = density)
    }

    /// Sets the centre of mass in the body's frame (m); none: the shapes'. The frame stays.
    pub fn set_center_of_mass(&mut self, center: Option<Vec2>) -> Result<()> {
        self.edit(|def| def.center_of_mass = center)
    }

    /// Replaces the shapes. The frame stays.
    pub fn set_shapes(&mut self, shapes: Vec<Part>) -> Result<()> {
        self.edit(|def| def.shapes = shapes)
    }

    /// Sets friction, restitution and the like of shapes that have none of their own.
    pub fn set_surface(&mut self, surface: Surface) -> Result<()> {
        self.edit(|def| def.surface = surface)
    }

    /// Sets what shapes that have no filter of their own can touch.
    pub fn set_filter(&mut self, filter: Filter) -> Result<()> {
        self.edit(|def| def.filter = filter)
    }

    /// Sets what shapes that have no role of their own are there for.
    pub fn set_role(&mut self, role: Role) -> Result<()> {
        self.edit(|def| def.role = role)
    }

    /// Sets friction, restitution and the like of one shape, counted from 0.
    pub fn set_part_surface(&mut self, part: usize, surface: SurfaceOverride) -> Result<()> {
        self.edit_part(part, |part| part.surface = surface)
    }

    /// Sets what one shape, counted from 0, can touch.
    pub fn set_part_filter(&mut self, part: usize, filter: FilterOverride) -> Result<()> {
        self.edit_part(part, |part| part.filter = filter)
    }

    /// Sets what one shape, counted from 0, is there for; none: as the body.
    pub fn set_part_role(&mut self, part: usize, role: Option<Role>) -> Result<()> {
        self.edit_part(part, |part| part.role = role)
    }

    fn edit_part(&mut self, part: usize, edit: impl FnOnce(&mut Part)) -> Result<()> {
        let shapes = self.get().info().def.shapes.len();
        if part >= shapes {
            let allowed = format!("a shape of the body, which has {shapes}, counted from 0");
            return Err(Error::invalid("part", part, allowed));
        }
        self.edit(|def| edit(&mut def.shapes[part]))
    }

    /// Sets how many times gravity acts.
    pub fn set_gravity_scale(&mut self, scale: Real) -> Result<()> {
        self.edit(|def| def.gravity_scale = scale)
    }

    /// Sets the decay rates of velocity and spin (1/s).
    pub fn set_damping(&mut self, linear: Real, angular: Real) -> Result<()> {
        self.edit(|def| (def.linear_damping, def.angular_damping) = (linear, angular))
    }

    /// Sets C and A of air drag ½ρCAv².
    pub fn set_drag(&mut self, coefficient: Real, width: DragWidth) -> Result<()> {
        self.edit(|def| (def.drag_coefficient, def.drag_width) = (coefficient, width))
    }
}
