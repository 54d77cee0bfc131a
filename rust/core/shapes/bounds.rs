//! Intervals on a line and boxes along the axes.

use serde::{Deserialize, Serialize};

use crate::math::{Real, Vec2, vec2};

/// A closed interval on a line (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub min: Real,
    /// Upper end.
    pub max: Real,
}

impl Interval {
    /// The interval that holds nothing.
    pub const EMPTY: Self = Self { min: Real::INFINITY, max: Real::NEG_INFINITY };

    /// Length (m); 0 for the empty interval.
    #[must_use]
    pub fn length(&self) -> Real {
        (self.max - self.min).max(0.0)
    }

    /// The smallest interval that holds this one and `x`.
    #[must_use]
    pub fn with(self, x: Real) -> Self {
        Self { min: self.min.min(x), max: self.max.max(x) }
    }

    /// The smallest interval that holds both.
    #[must_use]
    pub fn merged(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The interval grown by `margin` at both ends.
    #[must_use]
    pub fn grown(self, margin: Real) -> Self {
        Self { min: self.min - margin, max: self.max + margin }
    }

    /// The interval moved by `offset`.
    #[must_use]
    pub fn moved(self, offset: Real) -> Self {
        Self { min: self.min + offset, max: self.max + offset }
    }

    /// Extent of `points` along `direction`.
    pub(super) fn of(points: &[Vec2], direction: Vec2) -> Self {
        points.iter().fold(Self::EMPTY, |span, p| span.with(p.dot(&direction)))
    }
}

/// A box along the axes (m), borders included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Aabb {
    /// Lower left corner.
    pub min: Vec2,
    /// Upper right corner.
    pub max: Vec2,
}

impl Aabb {
    /// The box with these extents along x and y.
    #[must_use]
    pub fn new(x: Interval, y: Interval) -> Self {
        Self { min: vec2(x.min, y.min), max: vec2(x.max, y.max) }
    }

    /// Extent along x (m).
    #[must_use]
    pub fn width(&self) -> Real {
        self.max.x - self.min.x
    }

    /// Extent along y (m).
    #[must_use]
    pub fn height(&self) -> Real {
        self.max.y - self.min.y
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn merged(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// Whether the two boxes share a point.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.x <= other.max.x
            && other.min.x <= self.max.x
            && self.min.y <= other.max.y
            && other.min.y <= self.max.y
    }

    /// Whether `p` lies in the box.
    #[must_use]
    pub fn contains(&self, p: Vec2) -> bool {
        self.min.x <= p.x && p.x <= self.max.x && self.min.y <= p.y && p.y <= self.max.y
    }

    /// How far the two boxes are apart (m), 0 where they share a point.
    #[must_use]
    pub fn distance(&self, other: &Self) -> Real {
        (other.min - self.max).sup(&(self.min - other.max)).sup(&Vec2::zeros()).norm()
    }

    /// Half the length of the border, width + height (m): in the plane, the chance that a line meets the box
    /// goes with it.
    #[must_use]
    pub fn half_perimeter(&self) -> Real {
        self.width() + self.height()
    }

    /// The box grown by `margin` on every side.
    #[must_use]
    pub fn grown(&self, margin: Real) -> Self {
        let margin = vec2(margin, margin);
        Self { min: self.min - margin, max: self.max + margin }
    }

    /// The box moved by `offset`.
    #[must_use]
    pub fn moved(&self, offset: Vec2) -> Self {
        Self { min: self.min + offset, max: self.max + offset }
    }

    /// Whether `other` lies in the box.
    #[must_use]
    pub fn contains_box(&self, other: &Self) -> bool {
        self.contains(other.min) && self.contains(other.max)
    }
}
