//! Calls of the C library as nobody should make them, at random.

use morec_capi::*;
use proptest::prelude::*;

/// A handle to call with: one that was given (alive or destroyed, of either kind), or one that was not.
#[derive(Debug, Clone)]
pub enum Which {
    Given(usize),
    Null,
    OfSomethingElse,
    Number(usize),
}

#[derive(Debug, Clone)]
pub enum Call {
    Load {
        bytes: usize,
        out: bool,
    },
    DestroyIndex(Which),
    Facts(Which, usize, bool),
    Name(Which, u32, usize),
    Create {
        index: Which,
        options: bool,
        size: usize,
        words: [i32; 4],
        capacity: usize,
        secs: f64,
        skeleton: Bones,
    },
    DestroyRecognizer(Which),
    Push {
        on: Which,
        frame: Shown,
    },
    Poll {
        on: Which,
        capacity: usize,
        size: usize,
        count: bool,
    },
    Finish(Which),
    Reset(Which),
    Stats(Which, usize),
    JointOfRole(Which, i32),
    Eight(Eight),
}

/// A skeleton, or none.
#[derive(Debug, Clone)]
pub enum Bones {
    None,
    Chain {
        joints: usize,
        parent_step: i32,
        names: bool,
        offsets: Option<f64>,
        roles: bool,
    },
}

#[derive(Debug, Clone)]
pub struct Shown {
    pub is_null: bool,
    pub size: usize,
    pub time_secs: f64,
    pub joints: usize,
    pub value: Option<f64>,
    pub turned: Option<f64>,
    pub space: i32,
}

#[derive(Debug, Clone, Copy)]
pub enum Eight {
    Init(u8),
    SetDataSource(u8),
    Speed(f64),
    StopDataSource,
    IsDepleted,
    Start,
    Stop,
    Query(i32, bool, bool),
    Terminate,
}

fn which() -> impl Strategy<Value = Which> {
    prop_oneof![
        12 => any::<usize>().prop_map(Which::Given),
        1 => Just(Which::Null),
        1 => Just(Which::OfSomethingElse),
        1 => any::<usize>().prop_map(Which::Number),
    ]
}

/// Numbers as they come, and such as nobody should send.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -2.0..2.0f64,
        1 => prop::sample::select(vec![0.0, f64::NAN, f64::INFINITY, -1e300, 1e9, f64::MIN_POSITIVE]),
        1 => any::<f64>(),
    ]
}

/// The right size, mostly.
fn size(right: usize) -> impl Strategy<Value = usize> {
    prop_oneof![
        8 => Just(right),
        1 => prop::sample::select(vec![0, 1, right - 1, right + 8, 1024, 4096, usize::MAX]),
    ]
}

fn bones() -> impl Strategy<Value = Bones> {
    let chain = (
        0usize..25,
        -2..2i32,
        any::<bool>(),
        prop::option::of(number()),
        any::<bool>(),
    )
        .prop_map(
            |(joints, parent_step, names, offsets, roles)| Bones::Chain {
                joints,
                parent_step,
                names,
                offsets,
                roles,
            },
        );
    prop_oneof![2 => Just(Bones::None), 1 => chain]
}

fn shown() -> impl Strategy<Value = Shown> {
    let joints = prop_oneof![6 => Just(18usize), 1 => 0..30usize];
    let parts = (
        size(size_of::<MorecFrame>()),
        number(),
        joints,
        prop::option::weighted(0.9, number()),
    );
    let more = (
        prop::option::of(number()),
        prop_oneof![6 => Just(1), 2 => Just(2), 1 => any::<i32>()],
    );
    (any::<u8>(), parts, more).prop_map(
        |(rare, (size, time_secs, joints, value), (turned, space))| Shown {
            is_null: rare == 0,
            size,
            time_secs,
            joints,
            value,
            turned,
            space,
        },
    )
}

fn eight() -> impl Strategy<Value = Eight> {
    prop_oneof![
        (0..4u8).prop_map(Eight::Init),
        (0..5u8).prop_map(Eight::SetDataSource),
        prop_oneof![2 => Just(f64::INFINITY), 1 => number()].prop_map(Eight::Speed),
        Just(Eight::StopDataSource),
        Just(Eight::IsDepleted),
        Just(Eight::Start),
        Just(Eight::Stop),
        (
            prop_oneof![0..5i32, any::<i32>()],
            any::<bool>(),
            any::<bool>()
        )
            .prop_map(|(n, segments, count)| Eight::Query(n, segments, count)),
        Just(Eight::Terminate),
    ]
}

pub fn call() -> impl Strategy<Value = Call> {
    let words = (
        prop_oneof![9 => 1..3i32, 1 => any::<i32>()],
        prop_oneof![9 => 0..2i32, 1 => any::<i32>()],
    );
    let words = (
        words,
        prop_oneof![4 => Just(0), 1 => any::<i32>()],
        prop_oneof![9 => 0..2i32, 1 => any::<i32>()],
    )
        .prop_map(|((handedness, up), roles, flags)| [handedness, up, roles, flags]);
    let options = (
        words,
        prop_oneof![6 => Just(0usize), 1 => any::<usize>()],
        prop_oneof![5 => Just(0.0), 1 => number()],
    );
    let create = (
        which(),
        any::<u8>(),
        size(size_of::<MorecOptions>()),
        options,
        bones(),
    )
        .prop_map(
            |(index, rare, size, (words, capacity, secs), skeleton)| Call::Create {
                index,
                options: rare != 0,
                size,
                words,
                // As much as can be asked for would be taken.
                capacity: if capacity > 1 << 12 {
                    capacity | 1 << 30
                } else {
                    capacity
                },
                secs,
                skeleton,
            },
        );
    prop_oneof![
        2 => (prop_oneof![4 => Just(usize::MAX), 1 => any::<usize>()], any::<u8>())
            .prop_map(|(bytes, rare)| Call::Load { bytes, out: rare != 0 }),
        1 => which().prop_map(Call::DestroyIndex),
        1 => (which(), size(size_of::<MorecIndexFacts>()), any::<bool>()).prop_map(|(w, s, n)| Call::Facts(w, s, n)),
        1 => (which(), 0..9u32, 0..40usize).prop_map(|(w, class, size)| Call::Name(w, class, size)),
        4 => create,
        1 => which().prop_map(Call::DestroyRecognizer),
        12 => (which(), shown()).prop_map(|(on, frame)| Call::Push { on, frame }),
        4 => (which(), 0..5usize, size(size_of::<MorecEvent>()), any::<u8>())
            .prop_map(|(on, capacity, size, rare)| Call::Poll { on, capacity, size, count: rare != 0 }),
        1 => which().prop_map(Call::Finish),
        1 => which().prop_map(Call::Reset),
        1 => (which(), size(size_of::<MorecStats>())).prop_map(|(w, s)| Call::Stats(w, s)),
        1 => (which(), prop_oneof![0..18i32, any::<i32>()]).prop_map(|(w, role)| Call::JointOfRole(w, role)),
        6 => eight().prop_map(Call::Eight),
    ]
}
