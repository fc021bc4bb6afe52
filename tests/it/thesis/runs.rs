//! Which scene, device and variant a record belongs to.

use rtbench::thesis::scenes::{SceneKey, ThesisScene};
use rtbench::thesis::variant::Variant;

#[test]
fn a_scene_is_the_thesis_s_by_name_and_counts() {
    let key = SceneKey::from_counts;
    let thesis = SceneKey::Thesis;
    assert_eq!(key("bunny", 69_451, 35_947), thesis(ThesisScene::Bunny));
    assert_eq!(key("bun_zipper", 69_451, 35_947), thesis(ThesisScene::Bunny));
    assert_eq!(key("dragon_vrip", 871_414, 437_645), thesis(ThesisScene::Dragon));
    // The robots' vertices depend on who splits them: the name decides.
    assert_eq!(key("robots", 71_708, 99_999), thesis(ThesisScene::Robots));
    // The office has two published numbers of triangles.
    assert_eq!(key("office", 36_310, 1), thesis(ThesisScene::Office));
    // Nothing in the name: both counts decide.
    assert_eq!(key("my-scan", 1_087_716, 543_652), thesis(ThesisScene::Buddha));
    assert_eq!(key("my-scan", 1_087_716, 543_651), SceneKey::Other("my-scan".into(), 1_087_716));
    // Another tessellation never takes the thesis's place.
    let conference = key("conference", 207_512, 229_642);
    assert_eq!((conference.thesis(), conference.tessellation_of()), (None, Some(ThesisScene::Conference)));
    assert_eq!(conference.to_string(), "conference (207512)");
    assert_eq!(key("conference-obj", 207_512, 219_830).tessellation_of(), Some(ThesisScene::Conference));
    assert_eq!(key("hall", 15_000, 9).tessellation_of(), None);
    // A built-in scene's size is not said twice, other options are.
    assert_eq!(key("hall:triangles=15000", 14_752, 9).to_string(), "hall (14752)");
    assert_eq!(key("hall:triangles=15000,seed=2", 14_752, 9).to_string(), "hall:triangles=15000,seed=2 (14752)");
    assert_eq!(key("museum6:time=3", 14_380, 1), thesis(ThesisScene::Museum));
}

#[test]
fn variants_are_read_as_records_write_them() {
    assert!(Variant::parse("default").is_default() && Variant::parse("").is_default());
    let variant = Variant::parse("x=128,shadows=to-light");
    assert_eq!((variant.get("shadows"), variant.get("y")), (Some("to-light"), None));
    assert_eq!(variant.to_string(), "x=128,shadows=to-light");
    let base = Variant::of_thesis(Some(ThesisScene::Robots), "grid");
    assert_eq!(base, Variant::of("x", "128"));
    assert!(Variant::of_thesis(Some(ThesisScene::Robots), "bvh").is_default());
    assert_eq!(variant.only_beyond(&base), Some(("shadows", "to-light")));
    assert_eq!(variant.only_beyond(&Variant::default()), None);
    assert_eq!(Variant::parse("x=64,shadows=to-light").only_beyond(&base), None);
    assert_eq!(base.only_beyond(&base), None);
    // What cannot be read is not the default.
    assert!(!Variant::parse("odd").is_default());
    assert_eq!(Variant::parse("odd").to_string(), "odd");
}
