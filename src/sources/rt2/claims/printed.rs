//! Cases of what the document printed: its own orders and percentages, held against its claims. Where a claim repeats a
//! printed number there is no case.

use super::{Case, case};
use crate::compare::judge::{Outcome, Uncertain, all, less, not};
use crate::sources::rt2::gains::Reading;
use crate::sources::rt2::models::Model;
use crate::sources::rt2::published::{Order, Published, Quantity};

/// Is one structure before another? Undecided where the text names neither place.
fn before(order: &Order, one: &str, other: &str) -> Outcome {
    match (order.place(one), order.place(other)) {
        (Some(a), Some(b)) => less(Uncertain::exact(a as f64), Uncertain::exact(b as f64)),
        _ => Outcome::Undecided,
    }
}

fn cases(published: &Published, models: &[Model], quantity: Quantity, judge: impl Fn(&Order) -> Outcome) -> Vec<Case> {
    let of = |model: &Model| {
        let order = published.order(*model, quantity)?;
        Some(case(model.name(), "", judge(order), order.in_words()))
    };
    models.iter().filter_map(of).collect()
}

/// Claim 1.
pub fn ropes_first(published: &Published) -> Vec<Case> {
    let judge = |order: &Order| all([before(order, "ropes", "kd"), before(order, "ropes", "BVH")]);
    cases(published, &Model::ALL, Quantity::FrameRate, judge)
}

/// Claim 2u.
pub fn kdtree_before_bvh(published: &Published) -> Vec<Case> {
    cases(published, &Model::ALL, Quantity::FrameRate, |order| before(order, "kd", "BVH"))
}

/// Claim 3.
pub fn lead_on_points(published: &Published) -> Vec<Case> {
    let gain = |model| published.gain(model, Quantity::FrameRate);
    let Some((dino, alien)) = gain(Model::Dino).zip(gain(Model::Alien)) else { return Vec::new() };
    let lead = |percent| Uncertain::exact(Reading::More.ratio(percent));
    vec![case("Dino", "and Alien", less(lead(dino), lead(alien)), format!("{dino:.0} % here, {alien:.0} % there"))]
}

/// Claim 4.
pub fn bvh_between(published: &Published) -> Vec<Case> {
    let judge = |order: &Order| all([before(order, "min-max", "BVH"), before(order, "BVH", "sort")]);
    cases(published, &[Model::Alien, Model::Dino], Quantity::BuildTime, judge)
}

/// Claim 4a: of the three only the last is named.
pub fn bvh_slowest(published: &Published) -> Vec<Case> {
    let judge = |order: &Order| if order.place("BVH") == Some(2) { Outcome::Agrees } else { Outcome::Contradicts };
    cases(published, &[Model::Dragon], Quantity::BuildTime, judge)
}

/// Claim 6: the Dino is the pointed one.
pub fn memory(published: &Published) -> Vec<Case> {
    let judge = |order: &Order| {
        let kdtree_smaller = before(order, "kd", "BVH");
        let by_shape = if order.model == Model::Dino { not(kdtree_smaller) } else { kdtree_smaller };
        all([before(order, "BVH", "ropes"), by_shape])
    };
    cases(published, &Model::ALL, Quantity::Memory, judge)
}
