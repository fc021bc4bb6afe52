//! Packets of a subgroup on trees of two, four or eight children a node, for primary rays.

mod packet;

use super::algorithm::{Algorithm, Builder, Parameter, Parameters, Traversal};
use super::bvh::{self, widened};
use super::cpu::Twin;
use super::method::Group;
use super::options::{Axis, Kind, OptionInfo};
use super::selection::Selection;
use super::structure::StructureKind;
use super::wide::{self, Wide};
use crate::device::{Feature, Features};
use packet::Packets;

/// Packets of 8 to 64 primary rays; secondary rays go one by one.
pub static BVH_SUBGROUP: Algorithm = Algorithm {
    name: "bvh-subgroup",
    alias: "",
    summary: "BVH of up to eight children a node, primary rays in packets of eight lanes of a subgroup, others one by one",
    paper: "Wald, Slusallek, Benthin and Wagner 2001; Wald, Benthin and Boulos 2008; Ylitie, Karras and Laine 2017",
    builder: &BUILDER,
    traversal: |s| match width_of(s) {
        2 => &PACKETS2,
        4 => &PACKETS4,
        _ => &PACKETS8,
    },
    options: &[WIDTH, RAYS],
};

static BUILDER: Builder = Builder {
    purpose: |s| match width_of(s) {
        2 => "2",
        4 => "4",
        _ => "8",
    },
    options: &OPTIONS,
    ..wide::builder("bvh-subgroup", |s, scene| wide::build(s, scene, width_of(s) as usize))
};

/// Those of the BVH, with leaves that fill the lanes.
const OPTIONS: [OptionInfo; bvh::options::OPTIONS.len()] = {
    let mut options = [bvh::options::OPTIONS[0]; bvh::options::OPTIONS.len()];
    let mut i = 0;
    while i < options.len() {
        options[i] = bvh::options::OPTIONS[i];
        if let b"max_leaf" = options[i].key.as_bytes() {
            options[i].default = "8";
        }
        i += 1;
    }
    options
};

const WIDTH: OptionInfo = OptionInfo::new(
    Axis::Traversal,
    "width",
    "8",
    "children of a node: each is tested by a lane of its own",
    Kind::Word(&["2", "4", "8"]),
);

const RAYS: OptionInfo = OptionInfo::new(
    Axis::Traversal,
    "rays",
    "8",
    "primary rays of each of eight lanes",
    Kind::Word(&["1", "2", "4", "8"]),
);

const fn packets(structure: &'static StructureKind) -> Traversal {
    Traversal {
        kernel: "trace/subgroup/rays.wgsl",
        structure,
        parameters: |s| {
            let word = |key: &str| Parameter::Word(s.size(key) as u32);
            let cull = ("CULL", Parameter::Flag(true));
            Parameters::of(&[cull, widened::parameter(s), ("WIDTH", word("width")), ("RAYS", word("rays"))])
        },
        leaf_order: true,
        packets: Some(group),
        needs: Features::of(&[Feature::Subgroups]),
        twin: Some(TWIN),
        ..Traversal::INDEPENDENT
    }
}

static PACKETS2: Traversal = packets(&wide::PAIRS);
static PACKETS4: Traversal = packets(&wide::FOUR);
static PACKETS8: Traversal = packets(&wide::EIGHT);

const TWIN: Twin = |input| {
    let tree: &Wide = input.structure()?;
    Ok(input.with(Packets::new(&input, tree)))
};

fn width_of(s: &Selection) -> u32 {
    s.count("width").unwrap_or(8)
}

/// The pixels of a work-group: four by two packets.
fn group(parameters: &Parameters) -> Group {
    let (width, height) = match parameters.word("RAYS") {
        1 => (4, 2),
        2 => (4, 4),
        4 => (8, 4),
        _ => (8, 8),
    };
    Group { width: 4 * width, height: 2 * height }
}
