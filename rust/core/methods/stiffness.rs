//! Which of two methods moves a run to a tolerance: DOP853, or where its stability bounds the step and not its error, Radau's.
//!
//! Hairer, Wanner, "Solving Ordinary Differential Equations II" (1996), section IV.2: the step times the rate that the
//! slopes show is beyond the bound of stability in step after step where a problem is stiff. Where what is stiff turns with the
//! motion, as a rod that is a spring does, DOP853 stays far within that bound: its stages leave the curve, and stiff forces tell. So a rate far
//! above that at which velocities change says the same.

use crate::math::Real;
use crate::methods::jacobian::cost_of_factors;

/// Where DOP853's step times a rate is beyond its stability (decay: 6.1, DOP853's own code).
const BOUND: Real = 6.1;

/// How many times the rate at which velocities change another rate must be to be called stiff.
const APART: Real = 30.0;

/// Steps beyond it that say that the motion is stiff, and steps within it that say it is not.
const MANY: u32 = 15;
const FEW: u32 = 6;

/// Evaluations of a step of DOP853.
const OF_A_STEP: Real = 12.0;

/// Attempts of Radau's over which its cost is looked at.
const ATTEMPTS: u32 = 8;

/// Coordinates beyond which no matrix is made.
const MOST: usize = 1500;

/// The choice, as evaluations say: Radau's method is tried when what stiffness has cost so far would have paid for a try, and
/// left when DOP853 at the bound of its stability would be cheaper.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Whether Radau's method moves it now.
    pub stiff: bool,
    allowed: bool,
    coordinates: usize,
    /// Steps beyond the bound, and since then within it.
    beyond: u32,
    within: u32,
    /// Evaluations spent beyond the bound, and what must be spent before a try, in costs of one.
    spent: Real,
    patience: Real,
    /// The fastest rate seen (1/s), and what part of the longest stable step DOP853 took when it was left.
    rate: Real,
    part: Real,
    attempts: u32,
    cost: Real,
    passed: Real,
}

impl Choice {
    /// For a run of this many coordinates; not `allowed`: it stays with DOP853.
    pub fn new(coordinates: usize, allowed: bool) -> Self {
        let allowed = allowed && coordinates <= MOST;
        Self {
            stiff: false,
            allowed,
            coordinates,
            beyond: 0,
            within: 0,
            spent: 0.0,
            patience: 1.0,
            rate: 0.0,
            part: 1.0,
            attempts: 0,
            cost: 0.0,
            passed: 0.0,
        }
    }

    /// Whether rates are wanted after a step of DOP853.
    pub fn looks(&self) -> bool {
        self.allowed && !self.stiff
    }

    /// Takes in a step of DOP853 of length h at whose end velocities change, and forces follow velocities, at these rates.
    pub fn saw(&mut self, h: Real, [slow, rate]: [Real; 2]) {
        self.rate = rate;
        if h * rate > BOUND || rate > APART * slow {
            self.within = 0;
            self.beyond += 1;
            self.spent += OF_A_STEP;
            let of_a_try = 2.0 * self.coordinates as Real + cost_of_factors(self.coordinates);
            if self.beyond >= MANY && self.spent >= self.patience * of_a_try {
                self.stiff = true;
                self.part = (h * rate / BOUND).min(1.0);
                (self.attempts, self.cost, self.passed) = (0, 0.0, 0.0);
            }
        } else {
            self.within += 1;
            if self.within == FEW {
                (self.beyond, self.spent) = (0, 0.0);
            }
        }
    }

    /// Takes in an attempt of Radau's: what it cost, in evaluations, how far it went (s; 0 where it failed) and how fast anything moves
    /// now (1/s), where that was looked at.
    pub fn attempted(&mut self, cost: Real, passed: Real, rate: Option<Real>) {
        self.rate = rate.unwrap_or(self.rate);
        self.attempts += 1;
        self.cost += cost;
        self.passed += passed;
        if self.attempts < ATTEMPTS {
            return;
        }
        if self.cost > self.passed * OF_A_STEP / self.longest() {
            self.stiff = false;
            self.patience *= 2.0;
            (self.beyond, self.spent) = (0, 0.0);
        }
        (self.attempts, self.cost, self.passed) = (0, 0.0, 0.0);
    }

    /// The step that DOP853 would take (s).
    pub fn longest(&self) -> Real {
        self.part * BOUND / self.rate
    }
}
