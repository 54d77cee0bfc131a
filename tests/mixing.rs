//! What two surfaces make of their coefficients: the claims of each rule, the table, what is refused.

#![allow(clippy::unwrap_used)] // helpers of tests may, as tests do

use culbuto::body::{Friction, ImpactLaw, Mixing, PairOfMaterials, Rule, Surface};
use culbuto::math::Real;
use culbuto::{BodyDef, World};
use proptest::prelude::*;

fn rules() -> impl Strategy<Value = Rule> {
    prop::sample::select(Rule::ALL.map(|(_, rule)| rule).to_vec())
}

/// Coefficients as they are, and as nobody would give them.
fn coefficient() -> impl Strategy<Value = Real> {
    let odd = prop::sample::select(vec![0.0, Real::MIN_POSITIVE, 5e-324, 1.0, 1e200, Real::MAX]);
    prop_oneof![4 => 0.0..2.0, 1 => odd, 1 => 0.0..Real::MAX]
}

fn surfaces() -> impl Strategy<Value = Surface> {
    let material = prop::sample::select(vec![None, Some("ice"), Some("steel"), Some("wood")]);
    (coefficient(), 0.0..=1.0, 0.0..=1.0, 0.0..1.0, -2.0..2.0, material).prop_map(
        |(sticking, share, restitution, rolling_resistance, tangent_speed, material)| Surface {
            friction: Friction { sticking, sliding: share * sticking },
            restitution,
            rolling_resistance,
            tangent_speed,
            material: material.map(str::to_owned),
        },
    )
}

fn known(a: &str, b: &str) -> PairOfMaterials {
    let friction = Some(Friction { sticking: 0.03, sliding: 0.02 });
    PairOfMaterials { a: a.into(), b: b.into(), friction, restitution: None }
}

proptest! {
    #[test]
    fn rules_are_symmetric_and_finite(rule in rules(), a in coefficient(), b in coefficient()) {
        let mixed = rule.apply(a, b);
        prop_assert_eq!(mixed.to_bits(), rule.apply(b, a).to_bits());
        prop_assert!(mixed.is_finite() && mixed >= 0.0, "{}", mixed);
    }

    #[test]
    fn rules_grow_with_each_side(
        rule in rules(), a in coefficient(), b in coefficient(), more in coefficient(),
    ) {
        // One rounding of the root of each side, and of their product.
        let larger = rule.apply(a.max(more), b);
        prop_assert!(rule.apply(a, b) <= larger * (1.0 + 2.0 * Real::EPSILON));
    }

    #[test]
    fn means_lie_between_the_two(a in coefficient(), b in coefficient()) {
        let between = a.min(b)..=a.max(b);
        for rule in [Rule::GeometricMean, Rule::Average, Rule::Minimum, Rule::Maximum] {
            prop_assert!(between.contains(&rule.apply(a, b)), "{:?}", rule);
            prop_assert_eq!(rule.apply(a, a), a, "{:?}", rule);
        }
        prop_assert!(Rule::Hypotenuse.apply(a, b) >= a.max(b));
        if a <= 1.0 && b <= 1.0 {
            prop_assert!(Rule::Product.apply(a, b) <= a.min(b));
        }
    }

    #[test]
    fn rules_but_the_product_scale(rule in rules(), a in 0.0..2.0, b in 0.0..2.0, s in 1e-3..1e3) {
        let degree = if rule == Rule::Product { 2 } else { 1 };
        let (scaled, expected) = (rule.apply(s * a, s * b), Real::powi(s, degree) * rule.apply(a, b));
        prop_assert!((scaled - expected).abs() <= 8.0 * Real::EPSILON * expected);
    }

    #[test]
    fn a_pair_is_symmetric_and_a_surface_again(
        friction in rules(), restitution in rules(), a in surfaces(), b in surfaces(),
    ) {
        let table = vec![known("ice", "steel"), known("wood", "wood")];
        let mixing = Mixing { friction, restitution, table };
        let (one, other) = (mixing.mix(&a, &b), mixing.mix(&b, &a));
        prop_assert_eq!(one.friction, other.friction);
        prop_assert_eq!(one.restitution.to_bits(), other.restitution.to_bits());
        prop_assert_eq!(one.rolling_resistance, other.rolling_resistance);
        prop_assert_eq!(one.tangent_speeds, [a.tangent_speed, b.tangent_speed]);
        prop_assert_eq!(other.tangent_speeds, [b.tangent_speed, a.tangent_speed]);
        prop_assert!((0.0..=1.0).contains(&one.restitution));
        // A body with that surface is let in: kinetic friction is not above static friction.
        let Friction { sticking, sliding } = one.friction;
        prop_assert!(sliding <= sticking);
        let surface = Surface { friction: one.friction, restitution: one.restitution, ..a };
        World::default().add_body(BodyDef { surface, ..BodyDef::point(1.0) }).unwrap();
    }
}

#[test]
fn rules_give_what_their_formulas_do() {
    for (rule, expected) in [
        (Rule::GeometricMean, 1.2),
        (Rule::Hypotenuse, Real::sqrt(0.81 + 2.56)),
        (Rule::Product, 1.44),
        (Rule::Minimum, 0.9),
        (Rule::Maximum, 1.6),
        (Rule::Average, 1.25),
    ] {
        let mixed = rule.apply(0.9, 1.6);
        assert!((mixed - expected).abs() < 1e-15, "{rule:?}: {mixed}");
    }
    // The hypotenuse of two bouncing surfaces would be 1.13.
    let mixing = Mixing { restitution: Rule::Hypotenuse, ..Mixing::default() };
    let rubber = Surface { restitution: 0.8, ..Surface::default() };
    assert_eq!(mixing.mix(&rubber, &rubber).restitution, 1.0);
}

#[test]
fn the_table_goes_before_the_rules_in_either_order() {
    let of = |material: &str| Surface {
        material: Some(material.into()),
        restitution: 0.25,
        rolling_resistance: 0.1,
        ..Surface::default()
    };
    let mut mixing = Mixing::default();
    mixing.set_pair(known("ice", "steel"));
    mixing.set_pair(PairOfMaterials { restitution: Some(0.75), friction: None, ..known("x", "x") });
    for (a, b) in [("ice", "steel"), ("steel", "ice")] {
        let pair = mixing.mix(&of(a), &of(b));
        assert_eq!(pair.friction, Friction { sticking: 0.03, sliding: 0.02 });
        assert_eq!(pair.restitution, 0.25);
        assert_eq!(pair.rolling_resistance, 0.1);
    }
    let same = mixing.mix(&of("x"), &of("x"));
    assert_eq!((same.friction, same.restitution), (Friction::of(0.5), 0.75));
    let unknown = mixing.mix(&of("ice"), &of("x"));
    assert_eq!((unknown.friction, unknown.restitution), (Friction::of(0.5), 0.25));
    let nameless = mixing.mix(&of("ice"), &Surface::default());
    assert_eq!(nameless.friction, Friction::of(0.5));

    // Set again in the other order, it is replaced; without values, it is gone.
    mixing.set_pair(PairOfMaterials { friction: Some(Friction::of(0.2)), ..known("steel", "ice") });
    assert_eq!(mixing.mix(&of("ice"), &of("steel")).friction, Friction::of(0.2));
    mixing.set_pair(PairOfMaterials { friction: None, ..known("ice", "steel") });
    assert_eq!(mixing.mix(&of("ice"), &of("steel")).friction, Friction::of(0.5));
    assert_eq!(mixing.table.len(), 1);
}

#[test]
fn a_table_that_is_not_allowed_is_refused_and_the_old_one_stays() {
    let mut world = World::default();
    let good = Mixing { table: vec![known("ice", "steel")], ..Mixing::default() };
    world.set_mixing(good.clone()).unwrap();
    let friction = |sticking, sliding| PairOfMaterials {
        friction: Some(Friction { sticking, sliding }),
        ..known("ice", "steel")
    };
    let bounce = |e| PairOfMaterials { restitution: Some(e), ..known("ice", "steel") };
    for (table, words) in [
        (vec![friction(-1.0, -1.0)], "friction of \"ice\" and \"steel\" is -1"),
        (vec![friction(0.1, 0.2)], "kinetic friction of \"ice\" and \"steel\" is 0.2"),
        (vec![friction(Real::INFINITY, 0.2)], "static friction of"),
        (vec![friction(Real::NAN, 0.2)], "static friction of"),
        (vec![bounce(1.5)], "restitution of \"ice\" and \"steel\" is 1.5; allowed: 0 to 1"),
        (vec![bounce(Real::NAN)], "restitution of \"ice\""),
        (vec![known("ice", "steel"), known("steel", "ice")], "given twice"),
    ] {
        let error = world.set_mixing(Mixing { table, ..Mixing::default() }).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
        assert_eq!(world.settings().mixing, good);
    }
}

#[test]
fn settings_of_contacts_go_with_snapshots() {
    let mut world = World::default();
    let table = vec![known("ice", "steel")];
    world
        .set_mixing(Mixing { friction: Rule::Hypotenuse, restitution: Rule::Product, table })
        .unwrap();
    world.set_impact_law(ImpactLaw::Stronge);
    world.set_sleeping(true);
    let bytes = world.snapshot().to_bytes().unwrap();
    let copy = culbuto::world::Snapshot::from_bytes(&bytes, Vec::new()).unwrap().to_world();
    assert_eq!(copy.settings(), world.settings());
}
