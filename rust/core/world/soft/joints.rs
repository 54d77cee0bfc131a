//! Joints that hold a point of a deformable body.

use serde::{Deserialize, Serialize};

use super::Softs;
use crate::arena::Arena;
use crate::body::Bodies;
use crate::error::{Error, Result};
use crate::joint::{Given, Joint, JointDef, JointHandle, JointKind, MatterEnd};
use crate::math::{Real, Vec2, Wrench};
use crate::methods::contact_step::Group;
use crate::methods::contact_step::matter_ties::{End, MatterTie};
use crate::soft::{SoftBody, SoftHandle, Spot};
use crate::world::World;
use crate::world::joints::{centers_of, index_of, law_of, make, row_is_turn, rows_of};

/// A joint, and what of deformable bodies it holds; sides without one are as its definition says.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct SoftJoint {
    pub joint: JointHandle,
    pub ends: Ends,
}

/// What a definition asks of deformable bodies: on which sides of which; the spot, if it is known.
type Asked = [Option<(SoftHandle, Option<Spot>)>; 2];

/// What it holds of them.
type Ends = [Option<(SoftHandle, Spot)>; 2];

impl Softs {
    /// Makes a joint.
    fn joint(&self, bodies: &Bodies, mut def: JointDef, asked: &Asked) -> Result<(Joint, Ends)> {
        def.validated()?;
        let (mut ends, mut matter) = ([None; 2], [None; 2]);
        for side in 0..2 {
            let Some((handle, known)) = asked[side] else { continue };
            let body = self.bodies.get(handle)?;
            if def.bodies[side].is_some() {
                let allowed = "a rigid body or a deformable one on a side";
                return Err(Error::invalid("the pair of bodies", "both on one side", allowed));
            }
            let spot = match known {
                Some(spot) => spot,
                None => spot_at(body, &def.anchors[side])?,
            };
            def.anchors[side] = Given::Local(spot.of(body.positions()));
            matter[side] = Some(MatterEnd {
                inverse_mass: 1.0 / body.mass(),
                velocity: spot.of(body.velocities()),
            });
            ends[side] = Some((handle, spot));
        }
        if ends[0] == ends[1] {
            let allowed = "two different points";
            return Err(Error::invalid("the anchors", "the same point twice", allowed));
        }
        let joint = make::with_matter(bodies, def, matter)?;
        let turns = rows_of(bodies, &joint).as_slice().iter().any(row_is_turn);
        let kind = &joint.def.kind;
        let needs_axis = matches!(kind, JointKind::Wheel { .. }) && ends[0].is_some();
        if turns || needs_axis || matches!(kind, JointKind::Rack { .. } | JointKind::Custom) {
            let got = format!("{:?}, which needs how a point is turned", kind.name());
            let allowed = "a kind that holds points and no angles, its axis on the other body: a point does not turn";
            return Err(Error::invalid("a joint of a deformable body", got, allowed));
        }
        Ok((joint, ends))
    }

    /// Joints that hold a deformable body by its place among them, and the body.
    pub fn held(&self) -> impl Iterator<Item = (&SoftJoint, [Option<usize>; 2])> {
        self.joints.iter().map(|own| {
            let place = |end: Option<(SoftHandle, Spot)>| {
                end.and_then(|(handle, _)| self.bodies.index(handle).ok())
            };
            (own, own.ends.map(place))
        })
    }
}

/// The point of a body that a joint is to hold: local ones are places of its mesh at rest.
fn spot_at(body: &SoftBody, anchor: &Given) -> Result<Spot> {
    let (spot, off) = match *anchor {
        Given::Local(point) => body.nearest_at_rest(point),
        Given::World(point) => body.nearest(point),
    };
    // Round borders are made of straight pieces.
    if off <= body.side() {
        return Ok(spot);
    }
    let allowed = format!("within a side of its elements of the body, {:.3} m", body.side());
    Err(Error::invalid("the anchor", format!("{off:.3} m from the deformable body"), allowed))
}

/// Brings what joints say of points to where these are.
pub fn follow(softs: &Softs, joints: &mut Arena<Joint>) {
    for own in &softs.joints {
        let Ok(joint) = joints.get_mut(own.joint) else { continue };
        for side in 0..2 {
            let Some((handle, spot)) = own.ends[side] else { continue };
            let Ok(body) = softs.bodies.get(handle) else { continue };
            joint.def.anchors[side] = Given::Local(spot.of(body.positions()));
            if let Some(end) = &mut joint.matter[side] {
                end.velocity = spot.of(body.velocities());
            }
        }
    }
}

/// Fills in the joints of a group, whose deformable bodies hold their points on from their nodes.
pub fn ties(
    (softs, members): (&mut Softs, &[u32]),
    (bodies, joints): (&Bodies, &Arena<Joint>),
    (group, h): (&Group, Real),
    out: &mut Vec<MatterTie>,
) {
    out.clear();
    if softs.joints.is_empty() {
        return;
    }
    let mut spots: Vec<Vec<Spot>> = vec![Vec::new(); members.len()];
    for (own, places) in softs.held() {
        let piece = |side: usize| {
            places[side].and_then(|place| members.iter().position(|k| *k as usize == place))
        };
        let pieces = [piece(0), piece(1)];
        let Ok(place) = joints.index(own.joint) else { continue };
        let joint = &joints.values()[place];
        if pieces == [None; 2] || joint.def.kind == JointKind::Filter {
            continue;
        }
        let ends = [0, 1].map(|side| match (pieces[side], own.ends[side]) {
            (Some(k), Some((_, spot))) => {
                spots[k].push(spot);
                let first = softs.bodies.values()[members[k] as usize].positions().len();
                End::Point(k as u32, (first + spots[k].len() - 1) as u32)
            }
            _ => {
                let body = index_of(bodies, joint, side).map(|i| i as u32);
                let slot = group.bodies.iter().position(|own| Some(*own) == body);
                slot.map_or(End::Ground, |slot| End::Body(slot as u32))
            }
        });
        let scale = if joint.substep > 0.0 { h / joint.substep } else { 1.0 };
        let scale = if scale.is_finite() { scale } else { 0.0 };
        let impulses = joint.impulses.map(|impulse| impulse * scale);
        let mut tie = MatterTie::new(law_of(bodies, joint), ends, place as u32, impulses);
        let centers = centers_of(bodies, joint);
        (tie.origin, tie.apart) = (centers[0], centers[1] - centers[0]);
        out.push(tie);
    }
    for (k, spots) in members.iter().zip(&spots) {
        softs.bodies.values_mut()[*k as usize].hold(spots);
    }
}

/// Brings what joints did in a span of this duration in substeps of length h back to them.
pub fn keep(joints: &mut Arena<Joint>, ties: &[MatterTie], (duration, h): (Real, Real)) {
    for tie in ties {
        let joint = &mut joints.values_mut()[tie.place as usize];
        (joint.impulses, joint.substep) = (tie.impulses, h);
        let force = tie.given / duration;
        let finite = force.norm_squared().is_finite();
        joint.reaction = Wrench::new(if finite { force } else { Vec2::zeros() }, 0.0);
    }
}

/// Joints of deformable bodies.
impl World {
    /// Adds a joint that holds a point of a deformable body on one side or both. On that side the definition names no rigid body, and its anchor
    /// says which point: the one nearest to a place in the world, or of the mesh at rest where it is local. The joint acts on that point of the
    /// material wherever it goes; [`crate::world::JointRef::anchors`] says where it is.
    ///
    /// Any kind goes that holds points and no angles: distance, spring, rope, revolute, grab, wheel, pulley, filter. Springs given by their
    /// frequency take the mass of the whole deformable body.
    ///
    /// # Errors
    /// Those of [`World::add_joint`], kinds that hold an angle, and anchors that are not on the body.
    pub fn add_soft_joint(
        &mut self,
        def: JointDef,
        softs: [Option<SoftHandle>; 2],
    ) -> Result<JointHandle> {
        if softs == [None; 2] {
            return self.add_joint(def);
        }
        let asked = softs.map(|soft| soft.map(|soft| (soft, None)));
        let (joint, ends) = self.state.softs.joint(&self.state.bodies, def, &asked)?;
        let bodies = joint.def.bodies;
        let joint = self.state.joints.insert(joint);
        self.state.softs.joints.push(SoftJoint { joint, ends });
        self.soft_joints_changed(bodies);
        Ok(joint)
    }

    /// The deformable bodies that a joint holds.
    ///
    /// # Errors
    /// [`crate::Error::StaleHandle`] for a joint that is gone.
    pub fn soft_ends(&self, joint: JointHandle) -> Result<[Option<SoftHandle>; 2]> {
        self.state.joints.get(joint)?;
        let own = self.state.softs.joints.iter().find(|own| own.joint == joint);
        Ok(own.map_or([None; 2], |own| own.ends.map(|end| end.map(|(soft, _)| soft))))
    }

    /// Changes a joint that holds deformable bodies; false if it holds none.
    pub(in crate::world) fn edit_soft_joint(
        &mut self,
        joint: JointHandle,
        edit: impl FnOnce(&mut JointDef),
    ) -> Result<()> {
        let Some(place) = self.state.softs.joints.iter().position(|own| own.joint == joint) else {
            return Ok(());
        };
        let (own, before) = (self.state.softs.joints[place], self.state.joints.get(joint)?);
        let mut def = before.def.clone();
        edit(&mut def);
        let asked = [0, 1].map(|side| {
            let (soft, spot) = own.ends[side]?;
            let stays = def.anchors[side] == before.def.anchors[side];
            // Anchors of points stand in the world.
            def.anchors[side] = Given::World(def.anchors[side].vector());
            Some((soft, stays.then_some(spot)))
        });
        let bodies = [before.def.bodies, def.bodies];
        let (mut changed, ends) = self.state.softs.joint(&self.state.bodies, def, &asked)?;
        if bodies[0] == bodies[1] {
            make::carry_over(&self.state.bodies, before, &mut changed);
        }
        *self.state.joints.get_mut(joint)? = changed;
        self.state.softs.joints[place].ends = ends;
        bodies.into_iter().for_each(|pair| self.soft_joints_changed(pair));
        Ok(())
    }

    fn soft_joints_changed(&mut self, bodies: [Option<crate::body::BodyHandle>; 2]) {
        self.rejoin(bodies);
        self.wake_all();
    }

    /// Forgets joints that are gone.
    pub(in crate::world) fn forget_soft_joints(&mut self) {
        let crate::world::State { softs, joints, .. } = &mut self.state;
        softs.joints.retain(|own| joints.get(own.joint).is_ok());
    }

    /// Forgets the joints of a deformable body that goes.
    pub(super) fn unjoin_soft(&mut self, soft: SoftHandle) {
        let holds = |own: &&SoftJoint| own.ends.iter().flatten().any(|(own, _)| *own == soft);
        let gone: Vec<JointHandle> =
            self.state.softs.joints.iter().filter(holds).map(|own| own.joint).collect();
        for joint in gone {
            // They are there: what is gone was forgotten.
            let _ = self.remove_joint(joint);
        }
    }
}
