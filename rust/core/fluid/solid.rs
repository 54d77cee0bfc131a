//! Bodies as the fluid sees them: the edges of their borders, and what each adds at the particles near it.

use super::cells::Cells;
use super::kernel::{Kernel, lattice};
use super::shore::{Edge, Shore};
use crate::body::{Bodies, BodyDef, Mass, Role};
use crate::math::{Pose, Real, Twist, Vec2, cross, perp, vec2};
use crate::shapes::{Aabb, Ring};

/// How far curves may be from the edges that stand for them, over the spacing.
const SAG: Real = 0.01;

/// Longest edge over the support: what is longer is cut, so that few particles are asked of each.
const LONGEST: Real = 8.0;

/// The border of a body, in the frame of its centre of mass.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    edges: Vec<Edge>,
    /// Largest distance from the centre of mass (m).
    pub reach: Real,
}

impl Solid {
    /// Of the shapes of a body that stop others, for particles this far apart.
    #[must_use]
    pub fn new(def: &BodyDef, center: Vec2, spacing: Real) -> Self {
        let mut solid = Self::default();
        for part in &def.shapes {
            if def.role_of(part) == Role::Sensor {
                continue;
            }
            let shape = &part.shape;
            let radius = shape.extent_from(shape.centroid()).max(spacing);
            // A chord under an angle φ is r·φ²/8 from its arc.
            let angle = (8.0 * SAG * spacing / radius).sqrt();
            for ring in shape.outline(angle) {
                if shape.is_wire() {
                    thick(&ring, 0.5 * spacing).iter().for_each(|ring| solid.add(ring, spacing));
                } else {
                    solid.add(&ring.points, spacing);
                }
            }
        }
        for edge in &mut solid.edges {
            edge.ends.iter_mut().for_each(|end| *end -= center);
            solid.reach = edge.ends.iter().map(Vec2::norm).fold(solid.reach, Real::max);
        }
        solid
    }

    /// Adds a closed ring, counter-clockwise around what is solid.
    fn add(&mut self, ring: &[Vec2], spacing: Real) {
        let n = ring.len();
        let outward = |i: usize| {
            let along = ring[(i + 1) % n] - ring[i % n];
            -perp(along) / along.norm().max(Real::MIN_POSITIVE)
        };
        for i in 0..n {
            let (from, to) = (ring[i], ring[(i + 1) % n]);
            let pieces = ((to - from).norm() / (LONGEST * spacing)).ceil().clamp(1.0, 1e6) as u32;
            let own = outward(i);
            let [before, after] = [outward(i + n - 1) + own, own + outward(i + 1)];
            for k in 0..pieces {
                let at = |k: u32| from + (to - from) * (Real::from(k) / Real::from(pieces));
                let first = if k == 0 { before } else { own };
                let last = if k + 1 == pieces { after } else { own };
                self.edges.push(Edge { ends: [at(k), at(k + 1)], corners: [first, last] });
            }
        }
        self.edges.retain(|edge| edge.ends[0] != edge.ends[1]);
    }
}

/// The rings around a wire that is this thick on either side: its right forwards, its left backwards.
fn thick(wire: &Ring, half: Real) -> Vec<Vec<Vec2>> {
    let points = &wire.points;
    let n = points.len();
    let along = |i: usize| {
        let way = points[(i + 1) % n] - points[i % n];
        way / way.norm().max(Real::MIN_POSITIVE)
    };
    let side = |i: usize, sign: Real| {
        let (first, last) = (i == 0 && !wire.closed, i + 1 == n && !wire.closed);
        let before = if first { along(i) } else { along(i + n - 1) };
        let after = if last { before } else { along(i) };
        let sum = perp(before) + perp(after);
        // A sharp bend gets no corner longer than twice the thickness.
        let across = sum * (2.0 / sum.norm_squared().max(1.0));
        let end = Real::from(u8::from(last)) - Real::from(u8::from(first));
        points[i] + (across * sign + before * end) * half
    };
    let mut right: Vec<Vec2> = (0..n).map(|i| side(i, -1.0)).collect();
    let left = (0..n).rev().map(|i| side(i, 1.0));
    if wire.closed {
        return vec![right, left.collect()];
    }
    right.extend(left);
    vec![right]
}

/// What a body near a particle adds at it.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// The particle.
    pub particle: u32,
    /// Place of the body among those that are wet.
    pub wet: u32,
    /// From the body's centre of mass in the middle of the substep to the particle (m).
    pub arm: Vec2,
    /// Part of the kernel that the body fills.
    pub part: Real,
    /// Gradient of that (1/m).
    pub slope: Vec2,
    /// What it brakes by (1/m²).
    pub friction: Real,
    /// Distance of the particle to the border, squared, below 0 from inside (m²).
    depth: Real,
}

/// A body near particles.
#[derive(Clone, Copy, Debug)]
pub struct Wet {
    /// Its place in body order.
    pub body: u32,
    /// Its velocities: at the start of the substep, later as they will be at its end.
    pub twist: Twist,
    /// 1/m along x and y (1/kg).
    pub inverse_mass: Vec2,
    /// 1/I (1/(kg·m²)).
    pub inverse_inertia: Real,
}

impl Wet {
    fn new(body: usize, bodies: &Bodies) -> Self {
        let Mass { inverse, inverse_inertia, .. } = bodies.masses[body];
        let twist = bodies.twists[body];
        Self { body: body as u32, twist, inverse_mass: inverse, inverse_inertia }
    }

    /// Adds an impulse (N·s, N·m·s) about the centre of mass.
    pub fn push(&mut self, impulse: &Twist) {
        self.twist += self.response(impulse);
    }

    /// The change of velocity that an impulse gives.
    #[must_use]
    pub fn response(&self, impulse: &Twist) -> Twist {
        let linear = impulse.linear.component_mul(&self.inverse_mass);
        Twist::new(linear, impulse.angular * self.inverse_inertia)
    }
}

/// An impulse at the end of an arm, about the centre of mass.
#[must_use]
pub fn moment(arm: Vec2, impulse: Vec2) -> Twist {
    Twist::new(impulse, cross(arm, impulse))
}

/// The bodies near the particles, and what they add.
#[derive(Clone, Debug, Default)]
pub struct Touches {
    /// What bodies add, body after body.
    pub list: Vec<Touch>,
    /// The bodies.
    pub wet: Vec<Wet>,
    /// Place in the list of each particle's touch with the body at work.
    places: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Touches {
    /// Finds what each body adds at the particles, which stand in cells.
    pub fn find(
        &mut self,
        (solids, bodies): (&[Solid], &Bodies),
        (cells, positions): (&Cells, &[Vec2]),
        kernel: &Kernel,
        h: Real,
    ) {
        self.list.clear();
        self.wet.clear();
        self.places.clear();
        self.places.resize(positions.len(), NONE);
        let (low, high) = super::cells::bounds(positions);
        let filled = Aabb { min: low, max: high }.grown(kernel.support);
        for (body, solid) in solids.iter().enumerate() {
            let pose = &bodies.poses[body];
            let apart = pose.position - pose.position.sup(&filled.min).inf(&filled.max);
            if solid.edges.is_empty() || apart.norm() > solid.reach {
                continue;
            }
            let first = self.list.len();
            self.find_of((solid, pose), (cells, positions), kernel, &filled);
            if self.list.len() > first {
                let wet = Wet::new(body, bodies);
                // Arms count from where the centre is half a substep on, where the impulse acts.
                let center = pose.position + wet.twist.linear * (0.5 * h);
                self.finish_body(first, positions, center, kernel);
                self.wet.push(wet);
            }
        }
    }

    fn find_of(
        &mut self,
        (solid, pose): (&Solid, &Pose),
        (cells, positions): (&Cells, &[Vec2]),
        kernel: &Kernel,
        filled: &Aabb,
    ) {
        let rot = pose.rot();
        let reach = vec2(kernel.support, kernel.support);
        for edge in &solid.edges {
            let ends = edge.ends.map(|end| pose.position + rot.apply(end));
            let (low, high) = (ends[0].inf(&ends[1]) - reach, ends[0].sup(&ends[1]) + reach);
            if high.x < filled.min.x
                || high.y < filled.min.y
                || low.x > filled.max.x
                || low.y > filled.max.y
            {
                continue;
            }
            let edge = Edge { ends, corners: edge.corners.map(|corner| rot.apply(corner)) };
            cells.within(low, high, |run| {
                for i in run {
                    self.add(i, (&edge, positions[i]), kernel);
                }
            });
        }
    }

    fn add(&mut self, i: usize, (edge, x): (&Edge, Vec2), kernel: &Kernel) {
        let mut shore = Shore::default();
        let Some(depth) = edge.add(kernel, x, &mut shore) else { return };
        if self.places[i] == NONE {
            self.places[i] = self.list.len() as u32;
            self.list.push(Touch {
                particle: i as u32,
                wet: self.wet.len() as u32,
                arm: Vec2::zeros(),
                part: 0.0,
                slope: Vec2::zeros(),
                friction: 0.0,
                depth,
            });
        }
        let touch = &mut self.list[self.places[i] as usize];
        touch.part += shore.part;
        touch.slope += shore.slope;
        touch.friction += shore.friction;
        if depth.abs() < touch.depth.abs() {
            touch.depth = depth;
        }
    }

    fn finish_body(&mut self, first: usize, positions: &[Vec2], center: Vec2, kernel: &Kernel) {
        let lattice = lattice();
        for touch in &mut self.list[first..] {
            self.places[touch.particle as usize] = NONE;
            touch.arm = positions[touch.particle as usize] - center;
            let mut shore =
                Shore { part: touch.part, slope: touch.slope, friction: touch.friction };
            if touch.depth < 0.0 {
                shore.enclose(kernel);
            }
            // The square of the part: see `Lattice::wall`.
            touch.part = lattice.wall * shore.part * shore.part;
            touch.slope = shore.slope * (2.0 * lattice.wall * shore.part);
            touch.friction = lattice.friction * shore.friction;
        }
    }
}
