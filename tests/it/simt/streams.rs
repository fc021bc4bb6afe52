//! Hand-made events.

use rtbench::workloads::trace::count::Count;
use rtbench::workloads::trace::simt::{
    Event::{self, *},
    Group, Lockstep, NotWhole,
    Part::{All, One},
    Read, Stream, Sums, TestReads, choice, maybe, repeat, replay,
};
use rtbench::workloads::trace::traverse::Lanes;
use rtbench::workloads::trace::{Selection, TriangleRef};

const WHILE_WHILE: Lockstep = Lockstep::apart(&[repeat(&[
    repeat(&[One(Step), repeat(&[One(Pop)])]),
    maybe(&[One(Leaf), repeat(&[One(Test)]), repeat(&[One(Pop)])]),
])]);

const SEARCH: Lockstep = Lockstep::apart(&[repeat(&[choice(&[
    maybe(&[One(Leaf), repeat(&[One(Test)]), maybe(&[One(Pop)])]),
    maybe(&[One(Step)]),
])])]);

const PACKET: Lockstep = Lockstep::together(&[repeat(&[
    choice(&[maybe(&[One(Leaf), repeat(&[One(Test)])]), maybe(&[All(Step), maybe(&[All(Vote)])])]),
    maybe(&[All(Pop)]),
])]);

fn streams(lanes: &[&[Event]]) -> Lanes<Stream> {
    std::array::from_fn(|lane| {
        let mut stream = Stream::default();
        lanes.get(lane).into_iter().copied().flatten().for_each(|&event| stream.push(event));
        stream
    })
}

fn issue(lockstep: &Lockstep, group: Group, alive: u64, lanes: &[&[Event]]) -> Sums {
    let mut sums = Sums::default();
    replay(lockstep, group, alive, (&streams(lanes), TestReads::LeafOrder), &mut sums).unwrap();
    sums
}

/// Issued and lanes of an event.
fn of(sums: &Sums, event: Event) -> (u64, u64) {
    (sums.issued[event as usize], sums.lanes[event as usize])
}

const FOUR: Group = Group { size: 64, width: 4 };

#[test]
fn lanes_wait_in_while_while() {
    // The first lane goes three steps down, the second one; both loops of tests take as many turns as the longer one
    let lanes: [&[Event]; 3] = [&[Step, Step, Step, Leaf, Test], &[Step, Leaf, Test, Test, Test, Pop], &[]];
    let sums = issue(&WHILE_WHILE, FOUR, 0b111, &lanes);
    assert_eq!(sums.warps, 1);
    assert_eq!([of(&sums, Step), of(&sums, Leaf), of(&sums, Test), of(&sums, Pop)], [(3, 4), (1, 2), (3, 4), (1, 1)]);
    assert!((sums.utilisation(4).unwrap() - 11.0 / 32.0).abs() < 1e-12);
    // Pops within a step's turn belong to it
    let lanes: [&[Event]; 2] = [&[Step, Pop, Pop, Step, Leaf, Test], &[Step, Step, Pop, Leaf, Test]];
    let sums = issue(&WHILE_WHILE, FOUR, 0b11, &lanes);
    assert_eq!([of(&sums, Step), of(&sums, Pop), of(&sums, Leaf)], [(2, 4), (3, 3), (1, 2)]);
}

#[test]
fn lanes_at_different_branches_are_issued_apart() {
    let lanes: [&[Event]; 2] = [&[Step, Leaf, Test, Pop, Step], &[Leaf, Test, Test, Pop, Leaf, Test]];
    // Turns: step and leaf; leaf (first lane) and leaf (second lane) together; step
    let sums = issue(&SEARCH, FOUR, 0b11, &lanes);
    assert_eq!([of(&sums, Step), of(&sums, Leaf), of(&sums, Test), of(&sums, Pop)], [(2, 2), (2, 3), (3, 4), (2, 2)]);
}

#[test]
fn warps_go_alone_or_together() {
    // Lanes 0 and 4 are in two warps of four; the second ray is occluded after its first leaf
    let mut lanes: [&[Event]; 5] = [&[]; 5];
    lanes[0] = &[Step, Vote, Leaf, Test, Test, Pop, Leaf, Test];
    lanes[4] = &[Step, Vote, Leaf, Test];
    let group = Group { size: 8, width: 4 };
    let sums = issue(&PACKET, group, 0b1_0001, &lanes);
    assert_eq!(sums.warps, 2);
    assert_eq!([of(&sums, Step), of(&sums, Vote), of(&sums, Pop)], [(2, 2), (2, 2), (2, 1)]);
    assert_eq!([of(&sums, Leaf), of(&sums, Test)], [(3, 3), (4, 4)], "leaves by warps with a live lane");
    lanes[0] = &[Step, Leaf, Test];
    lanes[4] = &[Step, Step, Step, Leaf, Test];
    let sums = issue(&WHILE_WHILE, group, 0b1_0001, &lanes);
    assert_eq!((sums.warps, of(&sums, Step), of(&sums, Leaf)), (2, (4, 4), (2, 2)));
}

#[test]
fn shared_tests_are_divided_by_the_group() {
    let coop = registered("grid-coop");
    let nine = [Step, Test, Test, Test, Test, Test, Test, Test, Test, Test];
    let lanes: [&[Event]; 3] = [&nine, &nine, &[Step]];
    // 18 tests by 8 invocations in two warps: three turns each
    let sums = issue(&coop, Group { size: 8, width: 4 }, 0b111, &lanes);
    assert_eq!([of(&sums, Step), of(&sums, Test)], [(1, 3), (6, 18)]);
}

/// The loops that a structure's traversal states.
fn registered(structure: &str) -> Lockstep {
    let method = Selection::parse(structure).unwrap().method();
    method.traversal.lockstep.unwrap()(&method.parameters)
}

#[test]
fn registered_loops_are_those_of_the_kernels() {
    // A lane walks on to its next cell with triangles before any are tested
    let lanes: [&[Event]; 2] = [&[Step, Step, Step, Test, Step], &[Step, Test, Test, Step, Step, Test]];
    let sums = issue(&registered("grid-coop"), Group { size: 4, width: 4 }, 0b11, &lanes);
    assert_eq!([of(&sums, Step), of(&sums, Test)], [(5, 7), (2, 4)]);
    // Two pops and a restart of one lane keep the other one waiting
    let lanes: [&[Event]; 2] = [&[Step, Child, Pop, Pop, Restart, Step], &[Step, Child, Child, Pop, Leaf, Test]];
    let sums = issue(&registered("bvh8:stack=short"), FOUR, 0b11, &lanes);
    assert_eq!([of(&sums, Step), of(&sums, Child), of(&sums, Pop)], [(2, 3), (2, 3), (2, 3)]);
    assert_eq!([of(&sums, Restart), of(&sums, Leaf), of(&sums, Test)], [(1, 1), (1, 1), (1, 1)]);
    // A step, then a test, in one turn; a leaf of two triangles takes two turns
    let lanes: [&[Event]; 2] = [&[Step, Leaf, Test, Test, Pop, Leaf, Test], &[Step, Step, Leaf, Test]];
    let sums = issue(&registered("bvh-stack:loop=if-if"), FOUR, 0b11, &lanes);
    assert_eq!([of(&sums, Step), of(&sums, Test)], [(2, 3), (3, 4)]);
    // The tests of both leaves follow the second way down
    let lanes: [&[Event]; 2] =
        [&[Step, Turn, Pop, Step, Step, Leaf, Test, Leaf, Test], &[Step, Step, Turn, Step, Leaf, Test]];
    let sums = issue(&registered("bvh-stack:loop=speculative"), FOUR, 0b11, &lanes);
    assert_eq!([of(&sums, Step), of(&sums, Turn), of(&sums, Leaf), of(&sums, Test)], [(4, 6), (1, 2), (2, 3), (2, 3)]);
}

#[test]
fn a_wrong_reconvergence_is_noticed() {
    let fits = |lockstep: &Lockstep, lanes: &[&[Event]]| {
        replay(lockstep, FOUR, u64::MAX, (&streams(lanes), TestReads::LeafOrder), &mut Sums::default())
    };
    assert_eq!(fits(&WHILE_WHILE, &[&[Step, Leaf, Test, Pop, Leaf]]), Ok(()));
    let message = fits(&WHILE_WHILE, &[&[], &[Step, Leaf, Test, Restart]]).unwrap_err();
    assert!(message.contains("event 3 of lane 1, Restart, has no place"), "{message}");
    // A loop of tests in front of the leaf, and no loop over pops
    const WRONG: Lockstep =
        Lockstep::apart(&[repeat(&[repeat(&[One(Step)]), repeat(&[One(Test)]), maybe(&[One(Leaf)])])]);
    assert!(fits(&WRONG, &[&[Step, Leaf, Test, Pop]]).is_err());
    const ONE_POP: Lockstep = Lockstep::apart(&[repeat(&[
        repeat(&[One(Step)]),
        maybe(&[One(Leaf), repeat(&[One(Test)]), maybe(&[One(Pop)])]),
    ])]);
    assert!(fits(&ONE_POP, &[&[Step, Leaf, Test, Pop, Pop, Step]]).is_err());
}

#[test]
fn a_warp_without_a_live_lane_does_nothing() {
    let lanes: [&[Event]; 1] = [&[Step, Leaf, Test]];
    assert_eq!(issue(&WHILE_WHILE, FOUR, 0, &lanes), Sums::default());
    assert_eq!(issue(&PACKET, FOUR, 0, &lanes), Sums::default());
    // A ray that is not alive is not replayed
    let sums = issue(&WHILE_WHILE, FOUR, 0b10, &lanes);
    assert_eq!((sums.warps, of(&sums, Step)), (1, (0, 0)));
}

#[test]
fn sums_are_read_as_they_are_written() {
    let lanes: [&[Event]; 2] = [&[Step, Leaf, Test], &[Step]];
    let sums = issue(&WHILE_WHILE, FOUR, 0b11, &lanes);
    let values = sums.values();
    assert_eq!(values[0], ("warps".to_owned(), 1));
    assert!(values.iter().all(|(name, _)| Sums::has(name)) && !Sums::has("rays"));
    let get = |name: &str| values.iter().find(|(known, _)| known == name).map_or(0, |(_, value)| *value);
    let read = Sums::read(|name| Ok(get(name)));
    assert_eq!(read, Some(sums));
    assert_eq!(Sums::read(|_| Ok(0)), None);
    // A damaged count, and more lanes than warps have
    assert_eq!(Sums::read(|name| if name == "issued_test" { Err(NotWhole) } else { Ok(get(name)) }), None);
    assert!(sums.fits(2) && !sums.fits(1), "{sums:?}");
}

#[test]
fn loads_are_counted_in_distinct_segments() {
    // Nodes of 16 bytes; what three lanes read, in turns of the loop over steps
    const LOOP: Lockstep = Lockstep::apart(&[repeat(&[One(Step)]), maybe(&[One(Leaf), repeat(&[One(Test)])])])
        .reading(&[Read { event: Step, stride: 16, bytes: 16 }, Read { event: Leaf, stride: 32, bytes: 64 }]);
    let mut streams = streams(&[]);
    for (lane, reads) in [(0, &[0_u32, 9][..]), (1, &[1, 2]), (2, &[8])] {
        for &index in reads {
            streams[lane].push(Step);
            streams[lane].read(index);
        }
    }
    // The first lane's leaf is read from byte 96 to 160, the second one's has no index
    streams[0].push(Leaf);
    streams[0].read(3);
    streams[1].push(Leaf);
    let loads = |streams: &Lanes<Stream>, group, tests| {
        let mut sums = Sums::default();
        replay(&LOOP, group, 0b111, (streams, tests), &mut sums).unwrap();
        (sums.loads.issued, sums.loads.segments)
    };
    // Bytes 0, 16, 128; then 144, 32; then the leaf: by 32 bytes 2 + 2 + 2, by 64 2 + 2 + 2, by 128 2 + 2 + 2
    assert_eq!(loads(&streams, FOUR, TestReads::LeafOrder), (3, [6, 6, 6]));
    // By warps of one lane a load each, and the leaf's 64 bytes lie across a border of each size
    assert_eq!(loads(&streams, Group { size: 64, width: 1 }, TestReads::LeafOrder), (6, [7, 7, 7]));
    // Tests of references 0 and 2 (one segment of 32 bytes each), whose vertices of 32 bytes are 0, 1, 2 and 0, 4, 2
    let reference = |vertices| TriangleRef { vertices, triangle: 0 };
    let refs = [reference([0, 1, 2]), reference([9; 3]), reference([0, 4, 2])];
    let mut tests = self::streams(&[]);
    for (lane, index) in [(0, 0), (1, 2)] {
        tests[lane].push(Leaf);
        tests[lane].push(Test);
        tests[lane].read(index);
    }
    assert_eq!(loads(&tests, FOUR, TestReads::Indexed(&refs)), (4, [2 + 1 + 2 + 1, 1 + 1 + 2 + 1, 1 + 1 + 2 + 1]));
    // In leaf order 48 bytes from 0 and from 96 on
    assert_eq!(loads(&tests, FOUR, TestReads::LeafOrder), (1, [4, 3, 2]));
}

#[test]
fn all_warps_of_a_group_load_what_it_visits() {
    let together = PACKET.reading(&[Read { event: Step, stride: 32, bytes: 64 }]);
    let mut streams = streams(&[]);
    streams[0].push(Step);
    streams[0].read(2);
    let mut sums = Sums::default();
    let group = Group { size: 16, width: 4 };
    replay(&together, group, 1, (&streams, TestReads::LeafOrder), &mut sums).unwrap();
    assert_eq!((sums.loads.issued, sums.loads.segments), (4, [8, 4, 4]));
    // 18 tests are shared out among 8 invocations in two warps: 3 turns, the last one by one warp
    let mut streams = self::streams(&[]);
    for lane in 0..2 {
        streams[lane].push(Step);
        for index in 0..9 {
            streams[lane].push(Test);
            streams[lane].read(index);
        }
    }
    let mut sums = Sums::default();
    let group = Group { size: 8, width: 4 };
    replay(&registered("grid-coop"), group, 0b11, (&streams, TestReads::LeafOrder), &mut sums).unwrap();
    // In leaf order 48 bytes each: tests 0 to 3, 4 to 7; 8 and 0 to 2, 3 to 6; 7 and 8
    assert_eq!((sums.loads.issued, sums.loads.segments[0]), (5, [6, 6, 2 + 5, 7, 4].iter().sum()));
}
