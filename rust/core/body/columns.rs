//! The bodies of a world as parallel columns.

use serde::{Deserialize, Serialize};

use crate::arena::HandleMap;
use crate::body::{Body, BodyDef, BodyHandle, BodyKind};
use crate::error::Result;
use crate::math::{Pose, Real, Twist, Vec2, Wrench};
use crate::shapes::{MassProperties, Shape, Silhouette};

/// What Newton's second law needs of one body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mass {
    /// 1/m along x and y (1/kg); 0 along a locked axis and for bodies that are not dynamic.
    pub inverse: Vec2,
    /// 1/I (1/(kg·m²)); 0 where the rotation is locked.
    pub inverse_inertia: Real,
    /// m (kg).
    pub mass: Real,
    /// I about the centre of mass (kg·m²).
    pub inertia: Real,
    /// How much gravity counts along x and y; 0 along a locked axis.
    pub gravity_scale: Vec2,
}

impl Mass {
    /// The acceleration that `wrench` gives: a = F/m, α = τ/I.
    #[must_use]
    pub fn acceleration(&self, wrench: &Wrench) -> Twist {
        Twist::new(wrench.force.component_mul(&self.inverse), wrench.torque * self.inverse_inertia)
    }

    /// ½mv² + ½Iω² of a body that answers to forces; 0 of one that does not.
    #[must_use]
    pub fn kinetic_energy(&self, twist: &Twist) -> Real {
        let linear = if self.is_free() { self.mass * twist.linear.norm_squared() } else { 0.0 };
        let angular =
            if self.inverse_inertia > 0.0 { self.inertia * twist.angular.powi(2) } else { 0.0 };
        0.5 * (linear + angular)
    }

    /// Whether any force can move the body.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.inverse.x > 0.0 || self.inverse.y > 0.0 || self.inverse_inertia > 0.0
    }
}

/// What a step rarely needs of a body.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Info {
    /// The definition, kept up to date for all but the motion (position, velocity, force).
    pub def: BodyDef,
    /// Largest distance from the centre of mass to the body's outline (m): its size ℓ.
    pub size: Real,
    /// Outline as air sees it.
    #[serde(skip, default = "no_silhouette")]
    pub silhouette: Silhouette,
}

impl Info {
    fn new(def: BodyDef, center: Vec2) -> Self {
        let mut info = Self { def, size: 0.0, silhouette: no_silhouette() };
        info.rebuild(center);
        info
    }

    /// Derives what is not stored.
    fn rebuild(&mut self, center: Vec2) {
        let shapes: Vec<&Shape> = self.def.shapes.iter().map(|part| &part.shape).collect();
        self.silhouette = Silhouette::new(&shapes);
        self.size = shapes.iter().map(|s| s.extent_from(center)).fold(0.0, Real::max);
    }
}

/// What stands in for a silhouette until it is built.
fn no_silhouette() -> Silhouette {
    Silhouette::new(&[])
}

/// All bodies, in columns of equal length, in "body order".
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Bodies {
    pub(crate) map: HandleMap<Body>,
    /// Pose: position of the centre of mass, angle of the body's frame.
    pub poses: Vec<Pose>,
    /// Velocity of the centre of mass, angular velocity.
    pub twists: Vec<Twist>,
    /// Masses.
    pub masses: Vec<Mass>,
    /// Centres of mass in the bodies' frames (m).
    pub local_centers: Vec<Vec2>,
    /// Constant forces, until changed.
    pub forces: Vec<Wrench>,
    /// Forces for the next step only.
    pub applied: Vec<Wrench>,
    /// The rest.
    pub infos: Vec<Info>,
}

impl Bodies {
    /// Number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.poses.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.poses.is_empty()
    }

    /// Handles in body order.
    #[must_use]
    pub fn handles(&self) -> &[BodyHandle] {
        self.map.handles()
    }

    /// Which body stands where.
    #[must_use]
    pub fn map(&self) -> &HandleMap<Body> {
        &self.map
    }

    /// Place of a body in the columns, or an error if it is gone.
    pub fn index(&self, handle: BodyHandle) -> Result<usize> {
        self.map.index(handle)
    }

    /// Checks a definition and adds the body at the end of the columns.
    pub fn insert(&mut self, def: BodyDef) -> Result<BodyHandle> {
        def.validated()?;
        let sum = def.mass_properties()?;
        let pose = Pose::new(def.position, def.angle);
        self.poses.push(Pose::new(pose.apply(sum.center), def.angle));
        self.twists.push(Twist::new(def.velocity, def.angular_velocity));
        self.masses.push(def.mass_column(&sum));
        self.local_centers.push(sum.center);
        self.forces.push(Wrench::new(def.force, def.torque));
        self.applied.push(Wrench::ZERO);
        self.infos.push(Info::new(def, sum.center));
        Ok(self.map.insert())
    }

    /// Removes a body; the last one takes its place in the columns.
    pub fn remove(&mut self, handle: BodyHandle) -> Result<()> {
        let i = self.map.remove(handle)?;
        self.poses.swap_remove(i);
        self.twists.swap_remove(i);
        self.masses.swap_remove(i);
        self.local_centers.swap_remove(i);
        self.forces.swap_remove(i);
        self.applied.swap_remove(i);
        self.infos.swap_remove(i);
        Ok(())
    }

    /// Changes a definition: `edit` works on a copy, and nothing changes if the result is not allowed.
    /// The body's frame stays where it is and keeps the velocity of its points when the centre of
    /// mass moves.
    pub fn edit(&mut self, i: usize, edit: impl FnOnce(&mut BodyDef)) -> Result<()> {
        let origin = self.origin(i);
        let mut def = self.def(i);
        edit(&mut def);
        def.validated()?;
        let sum: MassProperties = def.mass_properties()?;
        let mut twist = Twist::new(def.velocity, def.angular_velocity);
        if sum.center != self.local_centers[i] {
            let moved = origin.rot().apply(sum.center - self.local_centers[i]);
            let locked = |axis: bool, v: Real| if axis { 0.0 } else { v };
            twist.linear = twist.at(moved);
            twist.linear.x = locked(def.locks.x, twist.linear.x);
            twist.linear.y = locked(def.locks.y, twist.linear.y);
            self.poses[i].position = origin.apply(sum.center);
        }
        self.twists[i] = twist;
        self.masses[i] = def.mass_column(&sum);
        self.local_centers[i] = sum.center;
        self.forces[i] = Wrench::new(def.force, def.torque);
        self.infos[i] = Info::new(def, sum.center);
        Ok(())
    }

    /// The definition that makes body `i` as it is now.
    #[must_use]
    pub fn def(&self, i: usize) -> BodyDef {
        let origin = self.origin(i);
        BodyDef {
            position: origin.position,
            angle: origin.angle,
            velocity: self.twists[i].linear,
            angular_velocity: self.twists[i].angular,
            force: self.forces[i].force,
            torque: self.forces[i].torque,
            ..self.infos[i].def.clone()
        }
    }

    /// Where the body's frame stands.
    #[must_use]
    pub fn origin(&self, i: usize) -> Pose {
        frame(&self.poses[i], self.local_centers[i])
    }

    /// Where the frames of all bodies stand.
    pub fn origins(&self) -> impl Iterator<Item = Pose> {
        self.poses.iter().zip(&self.local_centers).map(|(pose, local)| frame(pose, *local))
    }

    /// Puts the body's frame at a pose.
    pub fn set_origin(&mut self, i: usize, origin: Pose) {
        self.poses[i] = Pose::new(origin.apply(self.local_centers[i]), origin.angle);
    }

    /// Whether body `i` is of this kind.
    #[must_use]
    pub fn is(&self, i: usize, kind: BodyKind) -> bool {
        self.infos[i].def.kind == kind
    }

    /// Derives again what snapshots leave out.
    pub(crate) fn rebuild(&mut self) {
        let centers = self.infos.iter_mut().zip(&self.local_centers);
        centers.for_each(|(info, center)| info.rebuild(*center));
    }
}

/// The frame of a body whose centre of mass, at `local` in it, is at the position of `pose`.
fn frame(pose: &Pose, local: Vec2) -> Pose {
    if local == Vec2::zeros() {
        return *pose;
    }
    Pose::new(pose.position - pose.rot().apply(local), pose.angle)
}
