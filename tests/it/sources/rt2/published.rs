//! The published values: every row parses, and says what the document says; both readings of a percentage.

use rtbench::compare::judge::{Outcome, Uncertain};
use rtbench::sources::rt2::gains::{Reading, agrees};
use rtbench::sources::rt2::models::Model;
use rtbench::sources::rt2::published::{Quantity, data};

#[test]
fn every_row_is_read() {
    let published = data();
    assert_eq!((published.scenes.len(), published.orders.len(), published.gains.len()), (3, 9, 5));
    assert_eq!(published.scenes.iter().map(|s| s.triangles_thousands).collect::<Vec<_>>(), [32, 107, 847]);
    assert_eq!(published.size(), (1408, 768));
    let gain = |model, quantity| published.gain(model, quantity);
    let gains = Model::ALL.map(|model| (gain(model, Quantity::FrameRate), gain(model, Quantity::BuildTime)));
    assert_eq!(gains, [(Some(18.0), Some(55.0)), (Some(3.0), Some(75.0)), (None, Some(-13.0))]);
    assert!(Model::ALL.iter().all(|model| gain(*model, Quantity::Memory).is_none()));
    // Every figure has an order of every model; a place that the text does not name is empty.
    let order = |model, quantity| published.order(model, quantity).unwrap();
    assert_eq!(order(Model::Dino, Quantity::Memory).in_words(), "BVH, kd, ropes");
    let dragon = order(Model::Dragon, Quantity::BuildTime);
    assert_eq!((dragon.in_words().as_str(), dragon.place("sort"), dragon.place("BVH")), ("–, –, BVH", None, Some(2)));
    // The two parameters of the BVH that was measured.
    let parameter = |name: &str| published.parameters.iter().find(|p| p.parameter == name).map(|p| p.value);
    assert_eq!((parameter("greatest depth"), parameter("most triangles of a leaf")), (Some(440), Some(3)));
    assert!(rtbench::sources::rt2::structures::BVH.selection().contains("max_leaf=3"));
}

#[test]
fn a_percentage_has_two_readings() {
    let ratios = |percent| Reading::ALL.map(|reading| (100.0 * reading.ratio(percent)).round());
    assert_eq!([18.0, 3.0, 55.0, 75.0].map(ratios), [[118.0, 122.0], [103.0, 103.0], [155.0, 222.0], [175.0, 400.0]]);
    assert_eq!(ratios(-13.0), [87.0, 88.0]);
    for reading in Reading::ALL {
        for percent in [-50.0, 0.0, 18.0, 75.0] {
            assert!((reading.percent(reading.ratio(percent)) - percent).abs() < 1e-9);
        }
    }
}

#[test]
fn a_gain_agrees_within_ten_points_of_either_reading() {
    let exact = Uncertain::exact;
    let at = |ratio: f64| agrees(exact(1.0), exact(ratio), 18.0);
    // 1 + g: 1.08 to 1.28; 1 / (1 - g): 1.087 to 1.389
    let outcomes = [1.07, 1.09, 1.38, 1.40].map(at);
    use Outcome::{Agrees, Contradicts, Undecided};
    assert_eq!(outcomes, [Contradicts, Agrees, Agrees, Contradicts]);
    // With noise it may be any ratio near it
    let noisy = |ratio: f64| agrees(Uncertain::exact(1.0), Uncertain { noise: 0.05, ..exact(ratio) }, 18.0);
    assert_eq!([1.02, 1.04, 1.2, 1.45, 1.47].map(noisy), [Contradicts, Undecided, Agrees, Undecided, Contradicts]);
    // A loss
    let loss = |ratio: f64| agrees(exact(1.0), exact(ratio), -13.0);
    assert_eq!([0.7, 0.8, 0.9, 1.0].map(loss), [Contradicts, Agrees, Agrees, Contradicts]);
}
