//! Why each parameter has the value it has.

/// Path of a parameter, and the reason.
pub const NOTES: &[(&str, &str)] = &[
    (
        "features.rate_hz",
        "with `frames_per_tick`: 30 ticks a second",
    ),
    ("features.smooth_sigma_frames", "25 ms"),
    ("features.smooth_cut_frames", "50 ms of delay"),
    (
        "features.root_sigma_frames",
        "cut to the delay of the directions",
    ),
    (
        "features.root_cut_frames",
        "cut to the delay of the directions",
    ),
    (
        "decode.gate",
        "motion nearer to a negative than to the class is not the class; the prototype's 1.2 gave 59 false positives and 82 misses over 12 half splits, 1.0 gave 35 and 95",
    ),
    (
        "decode.gate_ticks",
        "short windows are as accurate as the prototype's long ones (3, 2, 3) and a quarter of a second earlier",
    ),
    ("decode.peak_ticks", "as `decode.gate_ticks`"),
    ("decode.lag_ticks", "as `decode.gate_ticks`"),
    (
        "decode.overlap_share",
        "a candidate reported a few ticks too long swallowed the motion that followed: a quarter of the misses in half splits; 0 in older indexes",
    ),
    (
        "decode.hold_ticks",
        "a wait of up to 67 ms, only where a short motion may be the end of a longer one, and only without a verifier; 3 gives the same; 0 in older indexes",
    ),
    (
        "decode.end_fall",
        "at the end of a stream only: a walk cut off in mid-step is nearest to a step at the cut while its distance still falls; the prototype accepts the cut",
    ),
    ("rho", "0.15 to 0.5 are alike"),
    (
        "max_pairs",
        "more pairs of samples give the same result; bounds time",
    ),
    (
        "everyday_may_pass",
        "synthetic motion may happen to be one of the classes",
    ),
    (
        "fallback_threshold",
        "used where there is no background at all",
    ),
    (
        "judge_whole",
        "sessions, one teacher, F1 of events 0.727 instead of 0.602, the same person 0.897 instead of 0.853; actions without rest, one teacher, 0.963 instead of 0.904. Its constants and where they were chosen are in [the method](method.md) and [trials](trials.md#the-second-look)",
    ),
    (
        "compact",
        "rows in signed bytes, one step for each column: a quarter of the size. Recognition uses the rows that the file holds",
    ),
    (
        "max_templates",
        "for each class; bounds time and file size; samples are taken from people in turn",
    ),
    (
        "whole_background",
        "short background clips count as a whole: their beginning and end are part of the example",
    ),
    (
        "reach",
        "candidates up to twice the distance that nine in ten samples need",
    ),
    (
        "examples_per_piece",
        "neighbouring examples say the same; bounds time",
    ),
    ("max_negative_examples", "bounds time"),
    ("min_negative_examples", "bounds time"),
    ("min_positives", "fewer give no reliable fit"),
    ("min_negatives", "fewer give no reliable fit"),
    ("verifier_ridge", "0.03 to 0.3 are alike"),
    ("bar_range", "bounds what the examples may decide"),
    (
        "activities",
        "exercises, third clip by two, F1 of events 0.865 instead of 0.800, everyday motion by style 0.655 instead of 0.596; sets of gestures are as without. The numbers of activities are in [the method](method.md) and were chosen on the first two ([trials](trials.md#activities))",
    ),
    ("kinds", "not chosen on data: what a user says"),
    (
        "EarlyDetectionParams.least_progress",
        "from a fifth of a template on",
    ),
    (
        "EarlyDetectionParams.reach",
        "0.85 and the gates of 0.9 after 1.8 and 1.1: precision of tentative events 0.96 for 0.68 on referee signals, 0.67 for 0.53 in Kinect sessions; recall 0.86 as before, and 0.94 for 0.96",
    ),
    ("keep", "thesis, §4.2"),
    (
        "sign",
        "the printed rule depends on the signs that eigenvectors come with",
    ),
    (
        "thresholds",
        "tuned: `accept` and `min_confidence` from left-out samples and background (`train/thesis/thresholds.rs`)",
    ),
    ("pose.rate_hz", "thesis, §4.2"),
    (
        "stages.chunk_frames",
        "thesis, §4.6.2; segments of 0.53 to 2.67 s. `k` is the number of chunks, as the text has it, not the sum's `k + 1`",
    ),
    ("stages.min_chunks", "thesis, §4.6.3"),
    ("stages.max_chunks", "thesis, §4.6.3"),
    (
        "stages.eigenvectors",
        "thesis, §4.5; tuned: the first direction about the database's mean is mostly the mean pose",
    ),
    (
        "stages.scaling",
        "thesis, §5.3: `(v + 1) / 2`; `singular_share` is Eq. 3.37",
    ),
    (
        "stages.centring",
        "thesis, §4.6.2; tuned: each segment's own mean is subtracted; in streams this decides",
    ),
    (
        "stages.accept",
        "thesis, §4.6.5; an argument of `Tree::descend`",
    ),
    (
        "stages.descent",
        "`larger`: §4.6.5; `both` gives up to four classes to scoring (§4.7.2)",
    ),
    (
        "stages.comparison",
        "thesis, §3.8; tuned: one value a frame matches too much: of unknown motion with wide kernels, 8 to 27 false alarms a minute were left; none with whole rows",
    ),
    (
        "stages.tolerance",
        "thesis, §3.8: of the standard deviation of all profile values",
    ),
    (
        "stages.normalisation",
        "thesis, §4.6.5; of equally cheap paths the longest. `least_ratio` is Marzal and Vidal's, many times slower",
    ),
    ("stages.prior_spread", "thesis, §4.6.5"),
    (
        "stages.maxima",
        "thesis, §4.6.5: \"higher than the confidence of its 8 neighbors\". Where segments of a motion match a profile in full, neighbours are equal to the bit: `peaks` then finds no maximum, and the more a tree accepts the more motions are lost",
    ),
    ("stages.overlap", "thesis, §4.6.5"),
    (
        "stages.min_confidence",
        "the thesis names none; segments that cannot reach it are not scored",
    ),
    (
        "stages.wait_chunks",
        "not in the thesis: bounds memory and delay; smaller reports sooner, on less knowledge. Tuned: reports 0.5 s after the end instead of 0.9 s, at the same accuracy",
    ),
    (
        "tree.sigma",
        "thesis, §4.5. Algorithm 4 settles on narrow kernels: it asks that samples lie on the boundary, which they do when each is alone, and new samples then fall outside. `algorithm4`, `scaled`, `quantile`, `fixed` and `cross_validated` are the alternatives",
    ),
    (
        "tree.solver",
        "`sor` is Algorithm 3; both find the same optimum, `active_set` sooner and whatever the kernel's width",
    ),
    ("tree.machine.own", "thesis, §4.5: `T`"),
    ("tree.machine.other", "thesis, §4.5: `t`"),
    ("tree.machine.penalty", "thesis, §4.5: `C`"),
    (
        "tree.machine.stop",
        "outputs are about 1: eight digits; the thesis stops when weights hardly move, which says little where the kernel is wide",
    ),
    ("tree.algorithm4.radius_factor", "thesis, §3.7.3 and §5.3"),
    ("tree.algorithm4.radius_step", "thesis, §3.7.3 and §5.3"),
    (
        "tree.algorithm4.lone_is_boundary",
        "a sample alone in its ball has no machine to ask",
    ),
    (
        "tree.algorithm4.sweep",
        "the thesis names no range but prints ten widths (Figs. 5.3 to 5.12: 0.0575 to 0.6725), each the mean of two sides': all are multiples of 0.0025, so steps are of 0.005, and the first width is at most 0.0575. That it is 0.05 and the last is 1 is inferred. `geometric` and `linear` go by the samples' distances. A side of fewer than two different samples takes the other side's width: Algorithm 4 does not cover it",
    ),
    (
        "tree.partition.exact_up_to",
        "every split is tried for few classes; with narrow kernels nearly every split stops Algorithm 6",
    ),
    (
        "tree.partition.unit_length",
        "as printed; without it a class of many samples tends to stand alone",
    ),
    (
        "PpcaParams.first_secs",
        "thesis, §4.3: 150 frames at 120 Hz",
    ),
    (
        "PpcaParams.ahead_secs",
        "thesis, §4.3: 150 frames at 120 Hz",
    ),
    ("PpcaParams.step_secs", "thesis, §4.3: 10 frames at 120 Hz"),
    (
        "PpcaParams.quality",
        "thesis, §3.4.1; the dimensions are chosen by a segment's first model and stay",
    ),
    (
        "PpcaParams.rise",
        "chosen on the cuts of `segmentation/` and `exercises/`",
    ),
    (
        "PpcaParams.fall",
        "a peak counts once half its rise is lost; chosen likewise",
    ),
    ("PpcaParams.same_secs", "half of `ahead_secs`"),
    ("PpcaParams.least_variance", "far below any sensor's noise"),
    ("KwasParams.k", "thesis, §4.4"),
    (
        "KwasParams.tau",
        "thesis, §4.4, of rows centred on the database. Its Tables 5.2–5.4 come nearer to uncentred rows (`morec group --method kwas --centre none`), where 0.995 is best on referee samples",
    ),
    (
        "features.heading",
        "not chosen on data: it follows what the clips with samples show",
    ),
    (
        "features.follow_noise",
        "without it 1 cm of white noise on referee signals by clip gave F1 0.765 instead of 0.947, 2 cm 0 instead of 0.911; nothing changes on clean clips",
    ),
    (
        "decode.spread_exponent",
        "F1 on referee by clip and by person, Kinect sessions by the same person and by others: 0.920, 0.872, 0.778, 0.724 at 0; 0.960, 0.901, 0.799, 0.754 at 0.75; 0.960, 0.864, 0.811, 0.762 at 1; chosen on these four; 0 in older indexes",
    ),
    (
        "decode.typical_spread",
        "not chosen on data: a body's is the median over referee signals and Kinect gestures, as ever; of hands and tracked points training takes the median of the index's templates",
    ),
    (
        "decode.rest_gate",
        "with `decode.rest_spread` at 0.5, F1 on referee by clip and by person, Kinect sessions by the same person and by others: 0.58: 0.917, 0.750, 0.855, 0.813; 0.60 (two faster copies): 0.949, 0.864, 0.855, 0.805; 0.62: 0.960, 0.889, 0.841, 0.808; 0.64: 0.960, 0.901, 0.818, 0.800; 0.66: 0.960, 0.901, 0.807, 0.774; 0 in older indexes",
    ),
    (
        "decode.rest_gate_verified",
        "with many samples the verifier weighs motion itself: gestures by person, right and `dontcare` accepted, 0.70: 0.951, 0.040; 0.75: 0.978, 0.040; 0.85: 0.973, 0.020",
    ),
    (
        "decode.noise_share",
        "0.5 and 0.75 alike on referee signals and Kinect actions as a webcam sees them; a bound where the measurement errs; 0 in older indexes",
    ),
    (
        "decode.rest_spread",
        "each with its best `decode.rest_gate`, F1 as there: 0 (0.77): 0.959, 0.899, 0.836, 0.779; 0.25 (0.70): 0.960, 0.901, 0.830, 0.797; 0.5 (0.62): 0.960, 0.889, 0.841, 0.808; 1 (0.50): 0.949, 0.780, 0.834, 0.812. Not looked at while choosing: half splits of 17 referee classes 0.934 instead of 0.927; gestures by person from 5 and 10 samples a class 0.761 and 0.880 right instead of 0.735 and 0.845; 0 in older indexes",
    ),
    (
        "decode.once",
        "without it, a short template reports the way out and a long one the way out and back of the same motion",
    ),
    (
        "decode.rival_share",
        "1.0, 1.05, 1.1: sessions, same person, 0.841, 0.844, 0.848, by others 0.808, 0.815, 0.813; everyday motion by style 0.576, 0.590, 0.588; half splits of 17 referee classes 0.934, 0.934, 0.933; figures 1 and 2 alike. Without it the first was 0.700, with it 0.790, both before later changes",
    ),
    (
        "decode.rival_ticks",
        "3, 6, 10, 15: half splits of 17 referee classes, seeds 13 to 18, F1 0.929, 0.933, 0.939, 0.943; sessions, same person, 0.824 to 0.836; figures 1 and 2 alike",
    ),
    (
        "decode.rival_overlap",
        "as `decode.rival_share`: 0.3 a little better than 0.5, 0.8 worse",
    ),
    (
        "decode.tail_spread",
        "the last, partial repetition of a run moved 0.24 to 0.60 of what the repetitions moved, repetitions 0.78 and more; seen on one class of one person, so it is the least sure of these",
    ),
    ("decode.tail_ticks", "0.2 s, as `decode.tail_spread`"),
    (
        "alarms_per_minute",
        "a rate people may want; 0.2 does alike",
    ),
    (
        "max_threshold",
        "where no background comes near; 2.2 and 1.8 cost new people on referee signals",
    ),
    (
        "quiet_share",
        "8 of 532 samples before a Kinect lie below it; they were near everything",
    ),
    (
        "verify_samples",
        "with the gate of `rest_gate_few`, gestures by person from 5 and 10 samples a class: 0.735 and 0.845 right with the verifier, 0.694 and 0.796 without (all `dontcare` 0.020); sessions by five others with background: 0.801 and 0.783; both before `decode.rest_spread`",
    ),
    (
        "many_samples",
        "gestures by person (50 samples a class) want the gate at 0.75 to 0.85, sessions by others (10) at 0.60 to 0.64; what lies between was not measured",
    ),
    (
        "rest_gate_few",
        "0.60, 0.62, 0.64, 0.67: sessions by others with background, F1 of events 0.834, 0.833, 0.834, 0.820; gestures by person from 5 and 10 samples a class, right: 0.761 and 0.880 at 0.64",
    ),
    ("verify_people", "as `verify_samples`"),
    (
        "stranger.discount",
        "half the squared difference of mean poses is the performer's stance; 1 is useless (Kinect gestures by one teacher, other performers 0.333). All five values were chosen with a prototype on 20 pairs of people before a Kinect and on the gesture sessions",
    ),
    (
        "stranger.rest_gate",
        "with a gate that is always open, the prototype's events of 20 pairs of people before a Kinect at 0.60, 0.70, 0.80, 0.90 without a discount: F1 0.854, 0.923, 0.931, 0.926; same person's sessions fall from 0.855 to 0.768 at 0.70, so it is closed for whoever performs like the teacher",
    ),
    (
        "stranger.rival_share",
        "1.15 instead of 1.05 with the gate open: sessions by one teacher 0.015 to 0.02 better, the 20 pairs 0.005 worse; 1.3 loses recall",
    ),
    (
        "stranger.open_at",
        "the person who taught is at 0.5 to 0.7, others at 1.2 to 1.4",
    ),
    (
        "stranger.close_at",
        "0.8, 1.0, 1.2: same person's sessions 0.806, 0.839, 0.844, the 20 pairs 0.948, 0.947, 0.927 (prototype, begun open)",
    ),
    (
        "faster_copies",
        "of the 12 signals of one clip at half and at two thirds of their duration 7 and 9 are recognised, 6 and 7 without, 6 and 8 by one copy; all 49 signals there F1 0.926 and 0.939 for 0.889 and 0.926; by clip and by person, sessions of the same person the same (0.949, 0.864, 0.855), by others 0.805 for 0.813; half splits of 17 referee classes 0.938 / 0.939 for 0.936 / 0.937",
    ),
    (
        "faster_duration",
        "0.50, 0.55, 0.60, 0.65 with two copies, of the 12 signals of one clip at half and at two thirds of their duration: 8 and 8, 7 and 9, 7 and 9, 6 and 9; half splits of 17 referee classes 0.937 / 0.938 with 0.55, 0.938 / 0.939 with 0.60; sessions by others alike",
    ),
    (
        "faster_people",
        "1: sessions of the same person 0.840, calibration 0.128; 2: 0.844 and 0.121; both with `decode.rest_gate` 0.62 and one copy",
    ),
    (
        "max_negatives",
        "17 referee classes, half split, seeds 1 and 4: accuracy and F1 0.942, 0.947; with 60 0.869, 0.857; 200 does the same as 120; where background is short there are fewer anyway",
    ),
];
