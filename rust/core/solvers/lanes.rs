//! Sweeps over eight blocks at a time.
//!
//! Blocks that share no body that gives way may be solved at once: each sees what it would have seen in its turn. They are
//! packed so that of two blocks that do share one, the earlier stands in an earlier packet. So a sweep gives the same
//! bits as `solvers::block::solve` on one block after the other, whatever the packing and whatever the processor: no
//! operation is fused or reordered.

pub(crate) mod kernel;
#[cfg(test)]
mod tests;

use multiversion::multiversion;

use super::block;
use super::sweep::Budget;
use crate::constraints::Velocity;
use crate::constraints::contact::Block;
use crate::math::{Real, Twist, vec2};

/// Blocks in a packet.
pub(crate) const LANES: usize = 8;

/// One number of each block of a packet.
pub(crate) type Lane = [Real; LANES];

/// Bits of each block of a packet.
pub(crate) type Mask = [u64; LANES];

/// J M⁻¹ Jᵀ of each block of a packet: 00, 11, 01, 0t, 1t, tt. Only what does not just stick needs it.
pub(crate) type Response = [Lane; 6];

/// A lane without a block.
const EMPTY: u32 = u32::MAX;

/// Flags of a lane: its first point takes part, its second point does, it slides.
pub(crate) const FIRST: u64 = 1;
pub(crate) const SECOND: u64 = 2;
pub(crate) const SLIDES: u64 = 4;

/// What a sweep needs of eight blocks.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(crate) struct Packet {
    /// Bodies A and B.
    pub bodies: [[u32; LANES]; 2],
    pub normal: [Lane; 2],
    pub arms: [[Lane; 2]; 3],
    pub target: [Lane; 3],
    pub inverse: [Lane; 6],
    pub impulse: [Lane; 3],
    /// Coefficients of what sticks and what slides.
    friction: [Lane; 2],
    pub flags: Mask,
    /// Some block has two points.
    pub two: bool,
}

/// Whether blocks are packed, or not because it does not pay.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum State {
    #[default]
    Unknown,
    Packed,
    Scalar,
}

/// Blocks in packets, and a copy of the bodies' velocities.
#[derive(Clone, Debug, Default)]
pub struct Lanes {
    state: State,
    /// Block of each lane, packet after packet.
    pub(crate) order: Vec<[u32; LANES]>,
    pub(crate) packets: Vec<Packet>,
    pub(crate) responses: Vec<Response>,
    pub(crate) velocities: Vec<Velocity>,
    /// One by one whatever pays, to compare.
    #[cfg(test)]
    pub off: bool,
    /// Packet in which each body is used last.
    last: Vec<u32>,
    /// Blocks in each packet, and the first packet from each one on that has room.
    filled: Vec<u32>,
    room: Vec<u32>,
}

impl Packet {
    const EMPTY: Self = Self {
        bodies: [[0; LANES]; 2],
        normal: [[0.0; LANES]; 2],
        arms: [[[0.0; LANES]; 2]; 3],
        target: [[0.0; LANES]; 3],
        inverse: [[0.0; LANES]; 6],
        impulse: [[0.0; LANES]; 3],
        friction: [[0.0; LANES]; 2],
        flags: [0; LANES],
        two: false,
    };

    fn load(&mut self, l: usize, block: &Block) {
        let [a, b] = block.bodies;
        (self.bodies[0][l], self.bodies[1][l]) = (a, b);
        (self.normal[0][l], self.normal[1][l]) = (block.normal.x, block.normal.y);
        for k in 0..3 {
            (self.arms[k][0][l], self.arms[k][1][l]) = (block.arms[k][0], block.arms[k][1]);
            self.target[k][l] = block.target[k];
            self.impulse[k][l] = block.impulse[k];
        }
        for k in 0..6 {
            self.inverse[k][l] = block.inverse[k];
        }
        self.two |= block.count == 2;
        self.friction[0][l] = block.friction.sticking;
        self.friction[1][l] = block.friction.sliding;
        let flag = |on: bool, flag: u64| if on { flag } else { 0 };
        self.flags[l] =
            flag(block.on[0], FIRST) | flag(block.on[1], SECOND) | flag(block.sliding, SLIDES);
    }
}

impl Packet {
    /// Gives a block its rows as they are.
    pub fn store(&self, l: usize, block: &mut Block) {
        block.normal = vec2(self.normal[0][l], self.normal[1][l]);
        for k in 0..3 {
            block.arms[k] = self.arms[k].map(|lane| lane[l]);
            (block.target[k], block.impulse[k]) = (self.target[k][l], self.impulse[k][l]);
        }
        block.inverse = self.inverse.map(|lane| lane[l]);
        block.on = [FIRST, SECOND].map(|flag| self.flags[l] & flag != 0);
        block.sliding = self.flags[l] & SLIDES != 0;
    }

    /// Solves one lane as the scalar version does.
    fn solve_one(
        &mut self,
        l: usize,
        (error, response): (&[Real; 3], &Response),
        (velocities, block): (&mut [Velocity], &mut Block),
    ) -> Real {
        self.store(l, block);
        block.response = response.map(|lane| lane[l]);
        let change = block::take(block, error, super::sweep::pair(velocities, block.bodies));
        (0..3).for_each(|k| self.impulse[k][l] = block.impulse[k]);
        self.flags[l] = self.flags[l] & !SLIDES | if block.sliding { SLIDES } else { 0 };
        change
    }
}

impl Lanes {
    /// Forgets the packing.
    pub fn clear(&mut self) {
        self.state = State::Unknown;
    }

    /// Whether packets pay for these blocks. They are packed once and then, until [`Lanes::clear`], taken for the same blocks on the
    /// same bodies.
    pub fn pay(&mut self, velocities: &[Velocity], blocks: &[Block]) -> bool {
        if blocks.len() < FEW {
            return false;
        }
        #[cfg(test)]
        if self.off {
            return false;
        }
        if self.state == State::Unknown {
            let rolls = blocks.iter().any(|block| block.rolling_resistance > 0.0);
            let pays = !rolls && self.pack(velocities, blocks);
            self.state = if pays { State::Packed } else { State::Scalar };
        }
        self.state == State::Packed
    }

    /// Packs blocks, each into the first packet after those of earlier blocks on the same bodies. Bodies that do not give way
    /// may stand in many blocks of a packet. Returns whether the packets are full enough to be worth it.
    pub(super) fn pack(&mut self, velocities: &[Velocity], blocks: &[Block]) -> bool {
        let Self { order, packets, responses, last, filled, room, .. } = self;
        last.clear();
        last.resize(velocities.len(), 0);
        order.clear();
        filled.clear();
        room.clear();
        for (k, block) in blocks.iter().enumerate() {
            let slots = block.bodies.map(|slot| slot as usize);
            let mut packet = last[slots[0]].max(last[slots[1]]);
            packet = first_with_room(room, packet);
            if packet as usize == order.len() {
                order.push([EMPTY; LANES]);
                filled.push(0);
                room.push(packet);
            }
            let place = packet as usize;
            order[place][filled[place] as usize] = k as u32;
            filled[place] += 1;
            if filled[place] as usize == LANES {
                room[place] = packet + 1;
            }
            for slot in slots {
                if !velocities[slot].is_fixed() {
                    last[slot] = packet + 1;
                }
            }
        }
        packets.clear();
        packets.resize(order.len(), Packet::EMPTY);
        responses.resize(order.len(), [[0.0; LANES]; 6]);
        blocks.len() >= LEAST * order.len()
    }

    /// Takes in the rows and the velocities.
    pub(crate) fn load(&mut self, velocities: &[Velocity], blocks: &[Block]) {
        self.take_velocities(velocities);
        let nobody = velocities.len() as u32;
        let packets = self.packets.iter_mut().zip(&mut self.responses);
        for ((packet, response), order) in packets.zip(&self.order) {
            packet.two = false;
            for (l, k) in order.iter().enumerate() {
                match blocks.get(*k as usize) {
                    Some(block) => {
                        packet.load(l, block);
                        (0..6).for_each(|k| response[k][l] = block.response[k]);
                    }
                    None => (packet.bodies[0][l], packet.bodies[1][l]) = (nobody, nobody),
                }
            }
        }
    }

    /// Takes in velocities.
    pub(crate) fn take_velocities(&mut self, velocities: &[Velocity]) {
        self.take_velocities_of(velocities.iter().copied());
    }

    /// The same one by one.
    pub(crate) fn take_velocities_of(&mut self, velocities: impl Iterator<Item = Velocity>) {
        self.velocities.clear();
        self.velocities.extend(velocities);
        // What empty lanes move.
        let inverse_mass = vec2(0.0, 0.0);
        self.velocities.push(Velocity { twist: Twist::ZERO, inverse_mass, inverse_inertia: 0.0 });
    }

    /// Gives back the velocities.
    pub(crate) fn give_velocities(&self, velocities: &mut [Velocity]) {
        let count = velocities.len();
        velocities.copy_from_slice(&self.velocities[..count]);
    }

    /// Gives back velocities and impulses.
    pub fn store(&self, velocities: &mut [Velocity], blocks: &mut [Block]) {
        self.give_velocities(velocities);
        for (packet, order) in self.packets.iter().zip(&self.order) {
            for (l, k) in order.iter().enumerate() {
                if let Some(block) = blocks.get_mut(*k as usize) {
                    block.impulse = [0, 1, 2].map(|k| packet.impulse[k][l]);
                    block.sliding = packet.flags[l] & SLIDES != 0;
                }
            }
        }
    }

    /// Gives the bodies the impulses that the blocks remember, as [`super::sweep::warm_start`] does.
    pub(crate) fn warm_start(&mut self) {
        warm_start(&mut self.packets, &mut self.velocities);
    }

    /// Sweeps until the budget is used up; the number of sweeps and the largest change in the last one (m/s).
    pub(crate) fn solve(&mut self, blocks: &mut [Block], budget: Budget) -> (u32, Real) {
        let mut result = (budget.most, 0.0);
        for sweep in 1..=budget.most {
            result = (sweep, self.sweep(blocks));
            if result.1 <= budget.tolerance {
                break;
            }
        }
        result
    }

    /// One sweep; returns the largest change of velocity along a row (m/s).
    fn sweep(&mut self, blocks: &mut [Block]) -> Real {
        let Self { order, packets, responses, velocities, .. } = self;
        sweep(packets, responses, order, (velocities, blocks))
    }
}

/// Blocks a packet from which on packets are worth it.
const LEAST: usize = 3;

/// Fewer blocks are solved one by one.
const FEW: usize = 16;

/// The first packet from this one on that has room; what was full on the way is skipped from then on.
fn first_with_room(room: &mut [u32], from: u32) -> u32 {
    let mut packet = from;
    while let Some(next) = room.get(packet as usize).copied().filter(|next| *next != packet) {
        packet = next;
    }
    let mut passed = from;
    while let Some(next) = room.get_mut(passed as usize).filter(|next| **next != passed) {
        passed = std::mem::replace(next, packet);
    }
    packet
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2", "x86_64+avx2"))]
fn warm_start(packets: &mut [Packet], velocities: &mut [Velocity]) {
    packets.iter_mut().for_each(|packet| kernel::warm_start(packet, velocities));
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2", "x86_64+avx2"))]
fn sweep(
    packets: &mut [Packet],
    responses: &[Response],
    order: &[[u32; LANES]],
    (velocities, blocks): (&mut [Velocity], &mut [Block]),
) -> Real {
    let mut changes = [0.0; LANES];
    for ((packet, response), order) in packets.iter_mut().zip(responses).zip(order) {
        let left = if packet.two {
            kernel::solve::<true>(packet, response, velocities, &mut changes)
        } else {
            kernel::solve::<false>(packet, response, velocities, &mut changes)
        };
        if let Some((left, error)) = left {
            for l in (0..LANES).filter(|l| left[*l] != 0) {
                let error = error.map(|lane| lane[l]);
                let change = packet.solve_one(
                    l,
                    (&error, response),
                    (velocities, &mut blocks[order[l] as usize]),
                );
                changes[l] = change.max(changes[l]);
            }
        }
    }
    changes.into_iter().fold(0.0, Real::max)
}
