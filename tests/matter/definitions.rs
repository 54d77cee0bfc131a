//! Definitions as they are written in files.

use culbuto::math::{Rot, vec2};
use culbuto::shapes::{Shape, ShapeDef};
use proptest::prelude::*;

use crate::common::{outline_and_holes, polygons};

#[test]
fn a_shape_is_written_as_its_definition() {
    let text = r#"{"box":{"width":2.0,"height":1.0}}"#;
    let shape: Shape = serde_json::from_str(text).unwrap();
    assert_eq!(shape, Shape::rectangle(2.0, 1.0).unwrap());
    let written = serde_json::to_string(&shape).unwrap();
    assert_eq!(written, r#"{"box":{"width":2.0,"height":1.0,"center":[0.0,0.0],"angle":0.0}}"#);
    for text in [
        r#"{"circle":{"radius":1}}"#,
        r#"{"regular_polygon":{"sides":5,"radius":1}}"#,
        r#"{"polygon":{"vertices":[[0,0],[1,0],[0,1]]}}"#,
        r#"{"capsule":{"a":[0,0],"b":[1,0],"radius":1}}"#,
        r#"{"segment":{"a":[0,0],"b":[1,0]}}"#,
        r#"{"arc":{"center":[0,0],"radius":1,"start":0,"sweep":1}}"#,
        r#"{"chain":{"points":[[0,0],[1,0],[1,1]],"closed":true}}"#,
    ] {
        serde_json::from_str::<Shape>(text).unwrap();
    }
}

#[test]
fn a_bad_definition_says_what_is_wrong() {
    let error = |text: &str| serde_json::from_str::<Shape>(text).unwrap_err().to_string();
    assert!(error(r#"{"circle":{"radius":-1}}"#).contains("radius of the circle is -1"));
    assert!(error(r#"{"circle":{"radius":1,"colour":2}}"#).contains("colour"));
    assert!(error(r#"{"circel":{"radius":1}}"#).contains("regular_polygon"));
}

#[test]
fn the_schema_names_every_kind() {
    let schema = serde_json::to_string(&schemars::schema_for!(Shape)).unwrap();
    for kind in
        ["circle", "box", "regular_polygon", "polygon", "capsule", "segment", "arc", "chain"]
    {
        assert!(schema.contains(&format!("\"{kind}\"")), "{kind}");
    }
}

proptest! {
    #[test]
    fn a_shape_read_back_has_the_same_bits(grid in polygons(), turn in 0.0..6.3, scale in 1e-6..1e6) {
        let (outline, holes) = outline_and_holes(&grid, [0, 0]);
        let place = |ring: &Vec<_>| ring.iter().map(|&p| Rot::new(turn).apply(p) * scale).collect::<Vec<_>>();
        let shape =
            Shape::polygon_with_holes(&place(&outline), &holes.iter().map(place).collect::<Vec<_>>()).unwrap();
        let bytes = postcard::to_stdvec(&shape).unwrap();
        let back: Shape = postcard::from_bytes(&bytes).unwrap();
        prop_assert_eq!(&back, &shape);
        prop_assert_eq!(back.second_moment().to_bits(), shape.second_moment().to_bits());
        prop_assert_eq!(back.centroid(), shape.centroid());
        prop_assert_eq!(back.convex_pieces(), shape.convex_pieces());
    }
}

#[test]
fn a_whole_definition_survives() {
    let def =
        ShapeDef::RegularPolygon { sides: 7, radius: 0.1, center: vec2(0.3, 1e-9), angle: 0.7 };
    let shape = Shape::new(def.clone()).unwrap();
    assert_eq!((shape.def(), ShapeDef::from(shape.clone())), (&def, def.clone()));
}
