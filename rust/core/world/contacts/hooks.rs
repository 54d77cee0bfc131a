//! What a user's own code may say about contacts while a step is at work.

use std::sync::Arc;

use super::near::Kind;
use super::view::seen;
use super::{Contacts, Near};
use crate::body::{Bodies, BodyHandle, Friction, Info, Part, Surface};
use crate::collision::Collider;
use crate::constraints::contact::{Memory, Touch};
use crate::error::{Error, Result};
use crate::forces::BoxError;
use crate::math::{Pose, Real, Twist, Vec2};
use crate::world::World;

/// A user's own rules of contact. All are called in the middle of a step, and see the world through their
/// arguments only. An error stops the step; the world is then as it was before the call.
pub trait ContactHooks: Send + Sync {
    /// Whether two shapes can touch at all; asked when their boxes meet, of those that their filters let meet,
    /// sensors included. It may be asked again for the same two, and should give the same answer.
    ///
    /// # Errors
    /// Whatever stops the step.
    fn allows(&self, a: &ShapeView<'_>, b: &ShapeView<'_>) -> std::result::Result<bool, BoxError> {
        let _ = (a, b);
        Ok(true)
    }

    /// Called in each step for each contact of solid shapes that touch or are about to, before it is solved.
    ///
    /// # Errors
    /// Whatever stops the step.
    fn pre_solve(&self, contact: &mut PreSolve<'_>) -> std::result::Result<(), BoxError> {
        let _ = contact;
        Ok(())
    }
}

/// A shape of a body, as hooks see it.
#[derive(Clone, Copy)]
pub struct ShapeView<'a> {
    bodies: &'a Bodies,
    index: usize,
    part: usize,
}

impl<'a> ShapeView<'a> {
    fn new(bodies: &'a Bodies, collider: &Collider) -> Self {
        Self { bodies, index: collider.body as usize, part: collider.part as usize }
    }

    /// The body.
    #[must_use]
    pub fn body(&self) -> BodyHandle {
        self.bodies.handles()[self.index]
    }

    /// Place of the body in body order.
    #[must_use]
    pub fn index(&self) -> usize {
        self.index
    }

    /// Which shape of the body, counted from 0.
    #[must_use]
    pub fn part(&self) -> usize {
        self.part
    }

    /// The shape, and what it has of its own.
    #[must_use]
    pub fn shape(&self) -> &'a Part {
        &self.info().def.shapes[self.part]
    }

    /// The body's definition and size.
    #[must_use]
    pub fn info(&self) -> &'a Info {
        &self.bodies.infos[self.index]
    }

    /// Where the body's frame stands.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.bodies.origin(self.index)
    }

    /// Velocity of the body's centre of mass (m/s) and its angular velocity (rad/s).
    #[must_use]
    pub fn twist(&self) -> Twist {
        self.bodies.twists[self.index]
    }
}

/// A contact that is about to be solved. What is changed holds for this step.
pub struct PreSolve<'a> {
    /// One shape.
    pub a: ShapeView<'a>,
    /// The other.
    pub b: ShapeView<'a>,
    /// Unit vector from A to B.
    pub normal: Vec2,
    /// Number of points, 1 or 2.
    pub count: usize,
    /// The points (m); only the first `count` hold.
    pub points: [Vec2; 2],
    /// Gaps at the points (m), below 0 where the surfaces overlap.
    pub gaps: [Real; 2],
    /// Coulomb's coefficients.
    pub friction: Friction,
    /// Restitution, 0 to 1.
    pub restitution: Real,
    /// Arm (m) by which the normal force opposes rolling.
    pub rolling_resistance: Real,
    /// Velocity (m/s) of B against A, along the normal turned by a quarter turn counter-clockwise, at which nothing
    /// slides.
    pub tangent_speed: Real,
    /// Whether the shapes resist one another. Shapes that do not count as not touching.
    pub enabled: bool,
}

/// What the hooks said of a patch.
#[derive(Clone, Copy)]
pub(in crate::world) struct Answer {
    pub touch: Touch,
    pub on: bool,
}

impl PreSolve<'_> {
    fn answer(&self) -> Result<Answer> {
        let Self { friction, restitution, rolling_resistance, tangent_speed, .. } = *self;
        let material = None;
        Surface { friction, restitution, rolling_resistance, tangent_speed, material }
            .validated()?;
        let touch = Touch { friction, restitution, rolling_resistance, tangent_speed };
        Ok(Answer { touch, on: self.enabled })
    }
}

/// The user's own rules.
impl World {
    /// Sets what the user's own code says about contacts; none: nothing, at no cost. Pairs that are near one another
    /// are asked about at once. Copies of a world have the same hooks; snapshots hold none, and going back to one
    /// keeps those of the world.
    ///
    /// # Errors
    /// What a hook reports; the world then keeps the hooks it had.
    pub fn set_hooks(&mut self, hooks: Option<Arc<dyn ContactHooks>>) -> Result<()> {
        self.wake_all();
        let Self { state, .. } = self;
        state.contacts.ask_again(&state.bodies, hooks.as_deref())?;
        self.hooks = hooks;
        Ok(())
    }

    /// The user's own code that speaks about contacts.
    #[must_use]
    pub fn hooks(&self) -> Option<&Arc<dyn ContactHooks>> {
        self.hooks.as_ref()
    }

    /// Asks the hooks about every contact of the step.
    pub(in crate::world) fn ask_before_solving(&mut self) -> Result<()> {
        let Self { state, scratch, hooks, .. } = self;
        let answers = &mut scratch.contacts.answers;
        answers.clear();
        let Some(hooks) = hooks else { return Ok(()) };
        let (contacts, bodies) = (&mut state.contacts, &state.bodies);
        for place in 0..contacts.patches.len() {
            let answer = contacts.ask(place, bodies, hooks.as_ref())?;
            if !answer.on {
                contacts.patches[place].memory = Memory::NEW;
            }
            answers.push(answer);
        }
        Ok(())
    }
}

/// What a hook reported, as the engine's error.
fn failed(source: BoxError) -> Error {
    Error::Hook { source }
}

/// Whether the hooks let two shapes meet.
pub(super) fn allowed(
    hooks: &dyn ContactHooks,
    bodies: &Bodies,
    [x, y]: [&Collider; 2],
) -> Result<bool> {
    let [a, b] = [x, y].map(|collider| ShapeView::new(bodies, collider));
    hooks.allows(&a, &b).map_err(failed)
}

impl Contacts {
    fn ask(&self, place: usize, bodies: &Bodies, hooks: &dyn ContactHooks) -> Result<Answer> {
        let patch = &self.patches[place];
        let near = &self.near[patch.near as usize];
        if !matches!(near.kind, Kind::Solid | Kind::OneWay { solid: true }) {
            return Ok(Answer { touch: near.touch, on: true });
        }
        let [x, y] = near.proxies.map(|proxy| &self.entries[proxy.0 as usize].collider);
        let [a, b] = [x, y].map(|collider| ShapeView::new(bodies, collider));
        let poses = [a.index, b.index].map(|i| &bodies.poses[i]);
        let seen = seen(&patch.manifold, poses);
        let mut contact = PreSolve {
            a,
            b,
            normal: seen.normal,
            count: patch.manifold.count,
            points: seen.points.map(|point| poses[0].position + point),
            gaps: seen.gaps,
            friction: near.touch.friction,
            restitution: near.touch.restitution,
            rolling_resistance: near.touch.rolling_resistance,
            tangent_speed: near.touch.tangent_speed,
            enabled: true,
        };
        hooks.pre_solve(&mut contact).map_err(failed)?;
        contact.answer()
    }

    /// Drops pairs that the hooks do not allow, and has those found again that earlier ones did not.
    fn ask_again(&mut self, bodies: &Bodies, hooks: Option<&dyn ContactHooks>) -> Result<()> {
        if let Some(hooks) = hooks {
            let ask = |near: &Near| {
                let pair = near.proxies.map(|proxy| &self.entries[proxy.0 as usize].collider);
                allowed(hooks, bodies, pair)
            };
            let kept: Vec<bool> = self.near.iter().map(ask).collect::<Result<_>>()?;
            let mut kept = kept.into_iter();
            self.drop_near(bodies.handles(), |_, _| kept.next() == Some(false));
        }
        for proxy in self.of_body.iter().flatten() {
            self.broad.touch(*proxy);
        }
        Ok(())
    }
}
