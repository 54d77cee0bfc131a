//! Substeps of a large group in which nothing is watched or joined, eight contacts at a time: the contacts are packed
//! once a step, and all that a substep does with them is done on the packets, to the same bits as one by one.

mod kernel;
mod part;

use multiversion::multiversion;

use part::Bodies;

use super::group::Group;
use super::{Link, Mass, Outcome};
use crate::collision::Normal;
use crate::constraints::{Place, Velocity};
use crate::math::{Real, Rot, Twist, vec2};
use crate::solvers::lanes::{LANES, Lane, Packet, Response};

/// What the normal of a lane's manifold is held by, and whether it has two points.
const ON_B: u64 = 1;
const BETWEEN: u64 = 2;
const INSIDE: u64 = 4;
const TWO: u64 = 8;

/// Manifolds of eight contacts.
#[derive(Clone, Debug)]
#[repr(align(64))]
struct Shape {
    kind: [u64; LANES],
    normal: [Lane; 2],
    on_a: [[Lane; 2]; 2],
    on_b: [[Lane; 2]; 2],
    radii: [Lane; 2],
    apart: [Lane; 2],
    width: Lane,
    tangent_speed: Lane,
    /// Some normal is held by a face; some is not.
    faces: bool,
    corners: bool,
    /// Gaps in the middle of the substep (m).
    gap: [Lane; 2],
    /// Normal impulses of the rows in the step (N·s).
    passed: Lane,
}

/// A group in packets.
#[derive(Clone, Debug, Default)]
pub struct Wide {
    /// Whether the group's substeps go by packets.
    pub on: bool,
    /// Largest normal velocity that the kick of the substep gives a contact (m/s).
    pub fastest: Real,
    shapes: Vec<Shape>,
    places: Vec<Place>,
    /// How often a group went by packets.
    #[cfg(test)]
    pub packings: u32,
    /// Packet and lane of each block.
    seats: Vec<[u32; 2]>,
    /// Blocks through which driven surfaces work.
    driven: Vec<u32>,
    /// For the passes of [`super::project`]: masses, and what each block was parted with.
    masses: Vec<Mass>,
    works: Vec<[Real; 4]>,
}

impl Shape {
    const EMPTY: Self = Self {
        kind: [0; LANES],
        normal: [[0.0; LANES]; 2],
        on_a: [[[0.0; LANES]; 2]; 2],
        on_b: [[[0.0; LANES]; 2]; 2],
        radii: [[0.0; LANES]; 2],
        apart: [[0.0; LANES]; 2],
        width: [0.0; LANES],
        tangent_speed: [0.0; LANES],
        faces: false,
        corners: false,
        gap: [[0.0; LANES]; 2],
        passed: [0.0; LANES],
    };

    fn load(&mut self, l: usize, link: &Link) {
        let manifold = &link.manifold;
        let (kind, normal) = match manifold.normal {
            Normal::OnA(normal) => (0, normal),
            Normal::OnB(normal) => (ON_B, normal),
            Normal::Between => (BETWEEN, vec2(0.0, 1.0)),
            Normal::Inside => (INSIDE, vec2(0.0, 1.0)),
        };
        let face = matches!(manifold.normal, Normal::OnA(_) | Normal::OnB(_));
        self.faces |= face;
        self.corners |= !face;
        self.kind[l] = kind | if manifold.count == 2 { TWO } else { 0 };
        for (i, (normal, apart)) in normal.iter().zip(&link.apart).enumerate() {
            (self.normal[i][l], self.apart[i][l]) = (*normal, *apart);
            for (k, anchor) in manifold.anchors.iter().enumerate() {
                (self.on_a[k][i][l], self.on_b[k][i][l]) = (anchor.on_a[i], anchor.on_b[i]);
            }
        }
        (self.radii[0][l], self.radii[1][l]) = (manifold.radius_a, manifold.radius_b);
        (self.width[l], self.tangent_speed[l]) = (link.width, link.tangent_speed);
    }
}

impl Wide {
    fn take_places(&mut self, places: &[Place]) {
        self.places.clear();
        self.places.extend_from_slice(places);
        // Of empty lanes.
        let (way, acceleration) = (vec2(0.0, 0.0), Twist::ZERO);
        self.places.push(Place { way, turn: 0.0, rot: Rot::IDENTITY, acceleration });
    }
}

/// Packs a group for the substeps of a step, where that pays.
pub fn start(group: &mut Group) {
    let Group { wide, lanes, velocities, blocks, links, watch, ties, .. } = group;
    let plain = watch.blocks.is_empty() && ties.is_empty();
    wide.on = plain && lanes.pay(velocities, blocks);
    if !wide.on {
        return;
    }
    #[cfg(test)]
    {
        wide.packings += 1;
    }
    lanes.load(velocities, blocks);
    wide.shapes.clear();
    wide.shapes.resize(lanes.order.len(), Shape::EMPTY);
    wide.seats.resize(blocks.len(), [0; 2]);
    for (p, (shape, order)) in wide.shapes.iter_mut().zip(&lanes.order).enumerate() {
        for (l, k) in order.iter().enumerate() {
            if let Some(link) = links.get(*k as usize) {
                shape.load(l, link);
                wide.seats[*k as usize] = [p as u32, l as u32];
            }
        }
    }
    find_driven(group);
}

/// Blocks with a driven surface: on a body that does not give way, or a conveyor.
fn find_driven(group: &mut Group) {
    let Group { wide, velocities, blocks, links, driven, .. } = group;
    wide.driven.clear();
    if !*driven {
        return;
    }
    for (k, (block, link)) in blocks.iter().zip(links).enumerate() {
        let fixed = block.bodies.iter().any(|slot| velocities[*slot as usize].is_fixed());
        if fixed || link.tangent_speed != 0.0 {
            wide.driven.push(k as u32);
        }
    }
}

/// Gives the blocks with a driven surface their rows as they are.
pub fn give_driven(group: &mut Group) {
    for n in 0..group.wide.driven.len() {
        give_row(group, group.wide.driven[n] as usize);
    }
}

/// Geometry of the middle of the substep of length h, and the rows that the kicks to come make of it.
pub fn place(group: &mut Group, h: Real) {
    let Group { wide, lanes, velocities, places, .. } = group;
    lanes.take_velocities(velocities);
    wide.take_places(places);
    let rows = (&mut lanes.packets[..], &mut lanes.responses[..]);
    wide.fastest = place_all(rows, &mut wide.shapes, (&lanes.velocities, &wide.places), h);
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2", "x86_64+avx2"))]
fn place_all(
    (packets, responses): (&mut [Packet], &mut [Response]),
    shapes: &mut [Shape],
    bodies: (&[Velocity], &[Place]),
    h: Real,
) -> Real {
    let mut most = [0.0; LANES];
    for ((packet, response), shape) in packets.iter_mut().zip(responses).zip(shapes) {
        kernel::place((packet, response), shape, bodies, (h, &mut most));
    }
    most.into_iter().fold(0.0, Real::max)
}

/// Adds up what the rows of a substep have passed on.
pub fn pass(group: &mut Group) {
    let Group { wide, lanes, .. } = group;
    for (shape, packet) in wide.shapes.iter_mut().zip(&lanes.packets) {
        for l in 0..LANES {
            shape.passed[l] += packet.impulse[0][l] + packet.impulse[1][l];
        }
    }
}

/// Gives the blocks the rows as they are.
fn give_rows(group: &mut Group) {
    let Group { wide, lanes, blocks, .. } = group;
    for ((shape, packet), order) in wide.shapes.iter().zip(&lanes.packets).zip(&lanes.order) {
        for (l, k) in order.iter().enumerate() {
            if let Some(block) = blocks.get_mut(*k as usize) {
                packet.store(l, block);
                block.gap = shape.gap.map(|lane| lane[l]);
            }
        }
    }
}

/// Ends a step: blocks and links are what they would be one by one.
pub fn finish(group: &mut Group) {
    give_rows(group);
    let Group { wide, lanes, links, .. } = group;
    for (shape, order) in wide.shapes.iter().zip(&lanes.order) {
        for (l, k) in order.iter().enumerate() {
            if let Some(link) = links.get_mut(*k as usize) {
                link.passed += shape.passed[l];
            }
        }
    }
}

/// Gives a block its row as it is.
pub fn give_row(group: &mut Group, k: usize) {
    let Group { wide, lanes, blocks, .. } = group;
    let [packet, lane] = wide.seats[k].map(|seat| seat as usize);
    lanes.packets[packet].store(lane, &mut blocks[k]);
    blocks[k].gap = wide.shapes[packet].gap.map(|gap| gap[lane]);
}

/// Takes in velocities and places for the passes of [`super::project`].
pub fn take_bodies(group: &mut Group) {
    let Group { wide, lanes, velocities, places, masses, .. } = group;
    lanes.take_velocities(velocities);
    wide.take_places(places);
    wide.masses.clear();
    wide.masses.extend_from_slice(masses);
    wide.masses.push(Mass::default());
    wide.works.resize(group.blocks.len(), [0.0; 4]);
}

/// Gives them back.
pub fn give_bodies(group: &mut Group) {
    let Group { wide, lanes, velocities, places, .. } = group;
    lanes.give_velocities(velocities);
    let count = places.len();
    places.copy_from_slice(&wide.places[..count]);
}

/// A pass that parts what overlaps, as [`super::project`] does. Whether anything was moved.
pub fn part(group: &mut Group, (pass, h): (usize, Real), outcome: &mut Outcome) -> bool {
    let Group { wide, lanes, .. } = group;
    let Wide { shapes, places, masses, works, .. } = wide;
    let bodies = Bodies { velocities: &mut lanes.velocities, places, masses };
    works.fill([0.0; 4]);
    let rows = (&lanes.packets[..], &shapes[..], &lanes.order[..]);
    let Some(largest) = part_all(rows, bodies, (pass, h), works) else { return false };
    outcome.residual = outcome.residual.max(largest);
    // In the order of the blocks, one after the other.
    for [first, second, third, fourth] in works {
        let work = &mut outcome.ledger.correction_work;
        *work -= *first;
        *work -= *second;
        *work += *third;
        *work += *fourth;
    }
    true
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2", "x86_64+avx2"))]
fn part_all(
    (packets, shapes, order): (&[Packet], &[Shape], &[[u32; LANES]]),
    mut bodies: Bodies<'_>,
    (pass, h): (usize, Real),
    works: &mut [[Real; 4]],
) -> Option<Real> {
    let mut largest = None;
    for ((packet, shape), order) in packets.iter().zip(shapes).zip(order) {
        let Some(parted) = part::part(packet, shape, &mut bodies, (pass, h)) else { continue };
        for l in (0..LANES).filter(|l| parted.lanes[*l] != 0) {
            works[order[l] as usize] = parted.work.map(|lane| lane[l]);
            largest = Some(parted.largest[l].max(largest.unwrap_or(0.0)));
        }
    }
    largest
}

/// v ≤ −v⁻ of every normal row; see [`super::settle`].
pub fn limit_targets(group: &mut Group, h: Real) {
    let Group { wide, lanes, velocities, places, free, .. } = group;
    let starts = velocities.iter().zip(&*places).zip(&*free).map(|((velocity, place), free)| {
        let kick = place.kick(h);
        let twist = Twist::new(free.linear - kick.linear, free.angular - kick.angular);
        Velocity { twist, ..*velocity }
    });
    lanes.take_velocities_of(starts);
    for (shape, packet) in wide.shapes.iter().zip(&mut lanes.packets) {
        kernel::limit(packet, shape, &lanes.velocities);
    }
    lanes.take_velocities(velocities);
}

/// Weakens all impulses to a part.
pub fn weaken(group: &mut Group, part: Real) {
    for packet in &mut group.lanes.packets {
        packet.impulse.iter_mut().flatten().for_each(|impulse| *impulse *= part);
    }
}
