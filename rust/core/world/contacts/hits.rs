//! Hits: what came together fast.

use super::Contacts;
use super::events::ContactEvent;
use super::view::seen;
use crate::body::Bodies;
use crate::math::{Real, Vec2};
use crate::methods::Span;
use crate::methods::contact_step::{Group, Hit, Link};

impl Contacts {
    /// Adds the hits of a group. The bodies are where they were at the start of the span, the group's velocities those
    /// of its end.
    pub(super) fn book_hits(
        &self,
        bodies: &Bodies,
        group: &Group,
        span: Span,
        events: &mut Vec<ContactEvent>,
    ) {
        for (block, link) in group.blocks.iter().zip(&group.links) {
            let patch = &self.patches[link.place as usize];
            let near = &self.near[patch.near as usize];
            let hit = if link.hit.impulse > 0.0 {
                Some(link.hit)
            } else if !near.touching && link.passed > 0.0 {
                self.landing(bodies, group, (block.bodies, link), span)
            } else {
                None
            };
            let Some(hit) = hit else { continue };
            let (pair, flipped) = self.shapes_of(near, bodies.handles());
            let start = bodies.poses[self.body_of(near.proxies[0]) as usize].position;
            events.push(ContactEvent {
                time: hit.time,
                bodies: pair.bodies,
                parts: pair.parts.map(|part| part as usize),
                point: Some(start + hit.point),
                normal: Some(if flipped { -hit.normal } else { hit.normal }),
                approach_speed: hit.approach,
                impulse: hit.impulse,
            });
        }
    }

    /// A new contact that the rows have braked, if it came faster than the forces of a substep make it. Time and speed
    /// are those of a fall through the gap at the start, v² = v₀² + 2ag.
    fn landing(
        &self,
        bodies: &Bodies,
        group: &Group,
        (slots, link): ([u32; 2], &Link),
        span: Span,
    ) -> Option<Hit> {
        let near = &self.near[self.patches[link.place as usize].near as usize];
        let [i, j] = near.proxies.map(|proxy| self.body_of(proxy) as usize);
        let poses = [&bodies.poses[i], &bodies.poses[j]];
        let seen = seen(&link.manifold, poses);
        let apart = poses[1].position - poses[0].position;
        let [pull_a, pull_b] = slots.map(|slot| group.places[slot as usize].acceleration.linear);
        let pull = -seen.normal.dot(&(pull_b - pull_a));
        let mut fastest: Option<(Real, Real, Vec2)> = None;
        for k in 0..link.manifold.count {
            let (on_a, gap) = (seen.points[k], seen.gaps[k].max(0.0));
            let apart = bodies.twists[j].at(on_a - apart) - bodies.twists[i].at(on_a);
            let start = -seen.normal.dot(&apart);
            let approach = (start * start.abs() + 2.0 * pull * gap).max(0.0).sqrt();
            let way = start + approach;
            let time = if way > 0.0 { (2.0 * gap / way).min(span.duration) } else { 0.0 };
            if fastest.is_none_or(|(most, ..)| approach > most) {
                let way = bodies.twists[i].at(on_a) * time + pull_a * (0.5 * time * time);
                fastest = Some((approach, time, on_a - seen.normal * (0.5 * gap) + way));
            }
        }
        let (approach, time, point) = fastest?;
        let resting = pull.abs() * span.h() * (1.0 + 1e-6);
        (approach > resting).then_some(Hit {
            impulse: link.passed,
            approach,
            time: span.start + time,
            point,
            normal: seen.normal,
        })
    }
}
