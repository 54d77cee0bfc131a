//! Small scenes that can be built at any size and anywhere, for what must not depend on either.

use crate::body::{BodyDef, BodyKind, Friction, Surface};
use crate::error::Result;
use crate::math::{Real, Vec2, vec2};
use crate::scenes::gauge::worse;
use crate::shapes::Shape;
use crate::world::World;

/// How large, and where.
#[derive(Clone, Copy, Debug)]
pub(in crate::scenes) struct Layout {
    /// Lengths are multiplied by this, times and speeds by its root, so that gravity stays what it is.
    pub size: Real,
    /// Where the origin stands (m).
    pub origin: Vec2,
}

impl Layout {
    /// As written.
    pub const PLAIN: Self = Self { size: 1.0, origin: vec2(0.0, 0.0) };

    /// At s times the size.
    pub fn of_size(size: Real) -> Self {
        Self { size, ..Self::PLAIN }
    }

    /// Moved.
    pub fn at(origin: Vec2) -> Self {
        Self { origin, ..Self::PLAIN }
    }

    /// By what times and speeds are multiplied.
    pub fn tempo(&self) -> Real {
        self.size.sqrt()
    }

    fn add(&self, world: &mut World, def: BodyDef) -> Result<()> {
        world.add_body(BodyDef {
            position: self.origin + def.position * self.size,
            velocity: def.velocity * self.tempo(),
            angular_velocity: def.angular_velocity / self.tempo(),
            ..def
        })?;
        Ok(())
    }

    fn rectangle(&self, width: Real, height: Real) -> Result<BodyDef> {
        Ok(BodyDef::new(Shape::rectangle(width * self.size, height * self.size)?))
    }

    fn circle(&self, radius: Real) -> Result<BodyDef> {
        Ok(BodyDef::new(Shape::circle(radius * self.size)?))
    }

    /// A world with a floor, its surface at height 0.
    fn floor(&self) -> Result<World> {
        let mut world = World::default();
        let kind = BodyKind::Static;
        let def = BodyDef { kind, position: vec2(0.0, -1.0), ..self.rectangle(64.0, 2.0)? };
        self.add(&mut world, def)?;
        Ok(world)
    }
}

/// Makes a scene at a size and a place.
pub(super) type Build = fn(Layout) -> Result<World>;

/// A scene, and for how many steps of 1/60 s its motion is told apart from chaos.
#[derive(Clone, Copy)]
pub(super) struct Small {
    pub name: &'static str,
    pub build: Build,
    pub steps: u32,
}

pub(super) const ALL: [Small; 3] = [
    Small { name: "a tumbling box", build: tumble, steps: 120 },
    Small { name: "a bouncing ball", build: bounce, steps: 120 },
    Small { name: "a small pile", build: pile, steps: 30 },
];

fn rough(friction: Real, restitution: Real) -> Surface {
    Surface { friction: Friction::of(friction), restitution, ..Surface::default() }
}

/// A box that lands on a corner, tumbles and slides.
fn tumble(layout: Layout) -> Result<World> {
    let mut world = layout.floor()?;
    let def = BodyDef {
        position: vec2(0.0, 1.5),
        angle: 0.25,
        velocity: vec2(3.0, 0.0),
        angular_velocity: 2.0,
        surface: rough(0.4, 0.25),
        ..layout.rectangle(1.0, 0.5)?
    };
    layout.add(&mut world, def)?;
    Ok(world)
}

/// A ball that bounces along the floor, and begins to spin.
fn bounce(layout: Layout) -> Result<World> {
    let mut world = layout.floor()?;
    let def = BodyDef {
        position: vec2(0.0, 2.0),
        velocity: vec2(1.5, 0.0),
        surface: rough(0.5, 0.8),
        ..layout.circle(0.25)?
    };
    layout.add(&mut world, def)?;
    Ok(world)
}

/// Boxes and balls that fall on one another.
pub(in crate::scenes) fn pile(layout: Layout) -> Result<World> {
    let mut world = layout.floor()?;
    for k in 0..6_u8 {
        let (k, even) = (Real::from(k), k % 2 == 0);
        let body = if even { layout.rectangle(0.75, 0.5)? } else { layout.circle(0.25)? };
        let def = BodyDef {
            position: vec2(0.125 * (2.0 * k % 3.0), 0.5 + 0.625 * k),
            angle: 0.125 * k,
            surface: rough(0.5, 0.0),
            ..body
        };
        layout.add(&mut world, def)?;
    }
    Ok(world)
}

/// A box on the floor.
pub(super) fn resting(layout: Layout) -> Result<World> {
    let mut world = layout.floor()?;
    let def = BodyDef { position: vec2(0.0, 0.5), ..layout.rectangle(1.0, 1.0)? };
    layout.add(&mut world, def)?;
    Ok(world)
}

/// Largest differences of two motions of one scene, each seen in its own layout: of places (m) and angles (rad); of
/// velocities (m/s).
pub(super) fn difference(
    Small { build, steps, .. }: Small,
    [one, other]: [Layout; 2],
    dt: Real,
) -> Result<[Real; 2]> {
    let mut worlds = [build(one)?, build(other)?];
    let mut worst = [0.0; 2];
    for _ in 0..steps {
        for (world, layout) in worlds.iter_mut().zip([one, other]) {
            world.step(dt * layout.tempo())?;
        }
        let [a, b] = [&worlds[0].bodies(), &worlds[1].bodies()];
        for i in 0..a.len() {
            let place = (a.poses[i].position - one.origin) / one.size
                - (b.poses[i].position - other.origin) / other.size;
            let velocity = a.twists[i].linear / one.tempo() - b.twists[i].linear / other.tempo();
            let turn = a.poses[i].angle - b.poses[i].angle;
            let apart = [place.norm().max(turn.abs()), velocity.norm()];
            worst = [0, 1].map(|k| worse(worst[k], apart[k]));
        }
    }
    Ok(worst)
}
