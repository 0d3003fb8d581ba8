/* morec: recognise motions live. The manual is README.md of morec-capi.
 *
 * Made from the sources of morec-capi; `MOREC_WRITE_HEADER=1 cargo test -p morec-capi header` makes it again.
 *
 * Handles are given back once, with the function that bears their name. Null, foreign and destroyed ones are refused
 * with a status, as are null pointers, misaligned ones and values that cannot be; what a pointer that is none of these
 * points to must be as the function says. An index may be used by any number of threads at once. One thread may push
 * into a recogniser while another polls it; a call that would meet another like it is refused with
 * MOREC_STATUS_BUSY and changes nothing. Different recognisers do not know of each other. Nothing calls back, and no
 * morec_ function starts a thread.
 */

#ifndef MOREC_H
#define MOREC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/**
 * Say what seems to be under way, too: starts, updates and cancellations beside the ends.
 */
#define MOREC_TENTATIVE 1

/**
 * Anyone performs: the bound of the score is never raised. For hands, tracked points and older indexes: more is accepted from the first
 * frame, not only once the performer's motions show somebody unlike the teacher.
 */
#define MOREC_PERFORMER_ANYONE 2

/**
 * The person who taught performs: the bound of the score is raised from the first frame by the scores of the teacher's samples.
 */
#define MOREC_PERFORMER_TEACHER 4

/**
 * Each repetition of an activity is an event of its own.
 */
#define MOREC_EACH_REPETITION 8

/**
 * Say how far from the nearest sample each gesture that ends, and each repetition that is an event, was.
 */
#define MOREC_DEVIATION 16

/**
 * Say with each frame how far every class has come: as many events, of the phase `Progress`. Of templates only.
 */
#define MOREC_PROGRESS 32

/**
 * Number of parts of the body; they are numbered from 0.
 */
#define MOREC_ROLE_COUNT 18

/**
 * Number of parts of the body, points of both hands, points of a custom skeleton and `face` together; they are numbered from 0.
 */
#define MOREC_POINT_COUNT 85

/**
 * Result of a call. Numbers stay what they are; later versions may add some.
 */
enum MorecStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Done.
     */
    MOREC_STATUS_OK = 0,
    /**
     * A pointer that must point to something is null.
     */
    MOREC_STATUS_NULL_POINTER = 1,
    /**
     * An invalid handle: never given, of another kind, or destroyed.
     */
    MOREC_STATUS_BAD_HANDLE = 2,
    /**
     * Invalid value; no change.
     */
    MOREC_STATUS_INVALID_VALUE = 3,
    /**
     * There is not enough room for the answer; the function's documentation says where the room needed is returned.
     */
    MOREC_STATUS_BUFFER_TOO_SMALL = 4,
    /**
     * Another thread is using this recogniser just now; nothing was changed.
     */
    MOREC_STATUS_BUSY = 5,
    /**
     * Events wait to be polled, and there is no room for more; the frame was not taken. Poll, and push it again.
     */
    MOREC_STATUS_QUEUE_FULL = 6,
    /**
     * A file cannot be read.
     */
    MOREC_STATUS_FILE = 7,
    /**
     * Bytes are not an index that this release reads.
     */
    MOREC_STATUS_BAD_INDEX = 8,
    /**
     * The index and what the stream shows of a body have no bone in common.
     */
    MOREC_STATUS_NOTHING_IN_COMMON = 9,
    /**
     * Not now: another call must come first.
     */
    MOREC_STATUS_WRONG_ORDER = 10,
    /**
     * A struct is smaller than its first version, or has fields set that this release does not know.
     */
    MOREC_STATUS_STRUCT_SIZE = 11,
    /**
     * A fault in morec itself. The handle should be destroyed; please report it.
     */
    MOREC_STATUS_INTERNAL = 12,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum MorecStatus MorecStatus;
#else
typedef int32_t MorecStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * A part of the body, played by the joint at its near end: the thigh by the hip joint, the shin by the knee, the hand
 * by the wrist. Torso is the first joint of the spine above the hips.
 */
enum MorecRole
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * No part that recognition knows.
     */
    MOREC_ROLE_NONE = -1,
    MOREC_ROLE_HIPS = 0,
    MOREC_ROLE_LEFT_THIGH = 1,
    MOREC_ROLE_LEFT_SHIN = 2,
    MOREC_ROLE_LEFT_FOOT = 3,
    MOREC_ROLE_RIGHT_THIGH = 4,
    MOREC_ROLE_RIGHT_SHIN = 5,
    MOREC_ROLE_RIGHT_FOOT = 6,
    MOREC_ROLE_TORSO = 7,
    MOREC_ROLE_NECK = 8,
    MOREC_ROLE_HEAD = 9,
    MOREC_ROLE_LEFT_SHOULDER = 10,
    MOREC_ROLE_LEFT_ARM = 11,
    MOREC_ROLE_LEFT_FOREARM = 12,
    MOREC_ROLE_LEFT_HAND = 13,
    MOREC_ROLE_RIGHT_SHOULDER = 14,
    MOREC_ROLE_RIGHT_ARM = 15,
    MOREC_ROLE_RIGHT_FOREARM = 16,
    MOREC_ROLE_RIGHT_HAND = 17,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum MorecRole MorecRole;
#else
typedef int32_t MorecRole;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Handedness of the coordinate axes.
 */
enum MorecHandedness
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Unset; the call fails.
     */
    MOREC_HANDEDNESS_UNKNOWN = 0,
    /**
     * As in OpenGL, glTF, Maya, Blender, Godot, OpenXR, BVH files.
     */
    MOREC_HANDEDNESS_RIGHT = 1,
    /**
     * As in Unity, Unreal, VMC.
     */
    MOREC_HANDEDNESS_LEFT = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum MorecHandedness MorecHandedness;
#else
typedef int32_t MorecHandedness;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The axis that points up.
 */
enum MorecUpAxis
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * As in Unity, Godot, glTF, Maya.
     */
    MOREC_UP_AXIS_Y = 0,
    /**
     * As in Unreal, Blender.
     */
    MOREC_UP_AXIS_Z = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum MorecUpAxis MorecUpAxis;
#else
typedef int32_t MorecUpAxis;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Frame of reference of positions and rotations.
 */
enum MorecSpace
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Unset; the call fails.
     */
    MOREC_SPACE_UNKNOWN = 0,
    /**
     * The world: `positions` are needed; `rotations` turn joints' axes into the world's.
     */
    MOREC_SPACE_WORLD = 1,
    /**
     * The parent's frame: `rotations` are needed; `positions` take the place of the skeleton's offsets. A root's are in
     * the world. Needs a skeleton.
     */
    MOREC_SPACE_LOCAL = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum MorecSpace MorecSpace;
#else
typedef int32_t MorecSpace;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Phase of a motion.
 */
enum MorecPhase
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * A motion seems to be under way. Tentative; only with `MOREC_TENTATIVE`.
     */
    MOREC_PHASE_START = 0,
    /**
     * Its progress, or what it seems to be, has changed. Tentative.
     */
    MOREC_PHASE_UPDATE = 1,
    /**
     * It came to nothing. Ends what a start began.
     */
    MOREC_PHASE_CANCEL = 2,
    /**
     * It has happened. Final: nothing that ended is taken back, and every motion ends once.
     */
    MOREC_PHASE_END = 3,
    /**
     * One more repetition of an activity is over, from the event's start to its stop; `repetitions` is its number. Only with
     * `MOREC_EACH_REPETITION`. (Not in the first version.)
     */
    MOREC_PHASE_REPETITION = 4,
    /**
     * How far one class has come, of every class with each frame that completes a row: `progress` is how far and `score` how like to a sample,
     * both 0 to 1, and `motion` is 0. Only with `MOREC_PROGRESS`. (Not in the first version.)
     */
    MOREC_PHASE_PROGRESS = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum MorecPhase MorecPhase;
#else
typedef int32_t MorecPhase;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Method of recognition of an index.
 */
enum MorecMethod
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Templates matched elastically, over the places of joints.
     */
    MOREC_METHOD_TEMPLATES = 0,
    /**
     * The method of 2009, over the rotations of joints.
     */
    MOREC_METHOD_SVRDM = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum MorecMethod MorecMethod;
#else
typedef int32_t MorecMethod;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * A loaded index: what recognition knows. It does not change; any number of threads may use it at once.
 */
typedef struct MorecIndex MorecIndex;

/**
 * A recogniser of one performer's motions.
 */
typedef struct MorecRecognizer MorecRecognizer;

/**
 * Figures of a stream. An unknown figure is NaN. Lengths are metres by a guess of the stream's unit.
 */
typedef struct MorecDiagnosis {
    /**
     * Set to `sizeof(MorecDiagnosis)` before the call.
     */
    size_t struct_size;
    /**
     * Frames looked at.
     */
    uint64_t frames;
    /**
     * `MorecFinding` bits; 0 until there is about a second of stream.
     */
    uint32_t findings;
    /**
     * A `MorecSeverity`: of the gravest finding.
     */
    int32_t severity;
    /**
     * Bit `r` for each `MorecRole` `r` that is never seen.
     */
    uint32_t missing_roles;
    /**
     * Bit `r` for each `MorecRole` `r` that is seen only at times.
     */
    uint32_t flickering_roles;
    /**
     * From the first frame to the last.
     */
    double secs;
    /**
     * Frames a second.
     */
    double rate_hz;
    /**
     * Half the range of nine tenths of the intervals at which frames arrived.
     */
    double jitter_secs;
    /**
     * Share of the frames that were due and did not come.
     */
    double lost_share;
    /**
     * Share of the frames that repeat the one before.
     */
    double repeated_share;
    /**
     * Share of the frames that show no body.
     */
    double empty_share;
    /**
     * From the ankles to the head joint along the bones.
     */
    double height_m;
    /**
     * Thigh and shin.
     */
    double leg_m;
    /**
     * Angle of a standing body, or of the trunk, with the vertical, radians.
     */
    double tilt_rad;
    /**
     * Standard deviation of fast noise on each coordinate.
     */
    double noise_m;
    /**
     * Share of the frames in which a joint is thrown aside.
     */
    double spike_share;
} MorecDiagnosis;

/**
 * A motion that was recognised: a segment of the stream, and what it shows.
 */
typedef struct MotionSeg {
    /**
     * Its number, from 1 since `mrStart`.
     */
    uint64_t number;
    /**
     * Its class in the index, from 0.
     */
    uint32_t class_id;
    /**
     * Frame of the clip at which it began.
     */
    uint32_t start_frame;
    /**
     * Frame at which it had ended.
     */
    uint32_t stop_frame;
    /**
     * Bytes of `class_name` without the zero.
     */
    uint32_t class_name_bytes;
    /**
     * Start, seconds from the beginning of the clip.
     */
    double start_secs;
    /**
     * Stop, seconds.
     */
    double stop_secs;
    /**
     * Probability that the motion is right, 0 to 1: a just accepted one has 0.05 to 0.44, by the kind of index. Of held poses and
     * of indexes without calibration (svrdm, older ones) it is the closeness to a sample instead.
     */
    double confidence;
    /**
     * The name of its class, UTF-8, with a zero at its end; cut if it is longer.
     */
    char class_name[64];
} MotionSeg;

/**
 * Facts about an index.
 */
typedef struct MorecIndexFacts {
    /**
     * Set to `sizeof(MorecIndexFacts)` before the call.
     */
    size_t struct_size;
    /**
     * Number of classes; they are numbered from 0.
     */
    uint32_t class_count;
    /**
     * The parts of the body that recognition looks at: bit `r` for the `MorecRole` `r`. A stream that lacks some is
     * compared by the others.
     */
    uint32_t roles;
    /**
     * Number of samples it learned from.
     */
    uint64_t sample_count;
    /**
     * Comparisons of the stream a second.
     */
    double tick_hz;
    /**
     * Method of recognition, a `MorecMethod`. Later releases may add some. Not in the first version of this struct.
     */
    int32_t method;
    /**
     * 1 if frames must say how joints are turned, 0 if where they are is enough. Not in the first version of this struct.
     */
    uint32_t needs_rotations;
} MorecIndexFacts;

/**
 * The joints of a stream's skeleton. Everything is copied; nothing is needed after the call it is given to.
 */
typedef struct MorecSkeleton {
    /**
     * Set to `sizeof(MorecSkeleton)`.
     */
    size_t struct_size;
    /**
     * Number of joints, 1 to 4096.
     */
    size_t joint_count;
    /**
     * `joint_count` numbers: the joint's parent, which must come before it, or −1 for a root.
     */
    const int32_t *parents;
    /**
     * `joint_count` names, UTF-8, by which roles are found if they are not given; or null. Of joints without parents they may
     * be landmarks, and points of hands.
     */
    const char *const *names;
    /**
     * `joint_count` times x, y, z: where the joint is in its parent's frame; or null if every frame says it.
     */
    const double *offsets;
    /**
     * `joint_count` times a `MorecRole`, `MOREC_ROLE_NONE` for most; or null: found by the tree, then the names. Points of hands
     * (`left_palm`, `left_thumb_1` … `right_little_tip`), points of a custom skeleton and `face` have the numbers from `MOREC_ROLE_COUNT`
     * to below `MOREC_POINT_COUNT`, which `morec_role_from_name` tells.
     */
    const int32_t *roles;
} MorecSkeleton;

/**
 * Options of a recogniser.
 */
typedef struct MorecOptions {
    /**
     * Set to `sizeof(MorecOptions)`.
     */
    size_t struct_size;
    /**
     * A `MorecHandedness`; must be said.
     */
    int32_t handedness;
    /**
     * A `MorecUpAxis`.
     */
    int32_t up_axis;
    /**
     * The stream's joints; null for a stream of roles, whose joint `r` plays `MorecRole` `r`.
     */
    const struct MorecSkeleton *skeleton;
    /**
     * For a stream of roles: bit `r` for each `MorecRole` `r` that it shows; 0 for all.
     */
    uint32_t roles;
    /**
     * `MOREC_TENTATIVE`, `MOREC_EACH_REPETITION`, `MOREC_DEVIATION`, `MOREC_PROGRESS`, and one of `MOREC_PERFORMER_ANYONE` and `MOREC_PERFORMER_TEACHER`; or 0.
     */
    uint32_t flags;
    /**
     * Events that can wait to be polled, 128 to 1048576; 0 for 256. Memory is taken for as many, and with `MOREC_PROGRESS` for those of
     * a frame at least.
     */
    size_t event_capacity;
    /**
     * A motion of the same class that ends less than this after the one before it is not reported, but counted. 0: every
     * motion is reported once.
     */
    double refractory_secs;
    /**
     * Sensitivity: false alarms a minute that background motion may raise, as in training, 0.1 strict … 1 generous.
     * 0: as trained. (Not in the first version of this struct.)
     */
    double sensitivity;
} MorecOptions;

/**
 * One performer's pose at one instant. Nothing of it is needed after the call.
 *
 * A joint that is not seen at this instant has a position, in local space a rotation, that is NaN; in local space a
 * position that is NaN stands for the skeleton's offset. Metres are best, but any one unit of length will do.
 */
typedef struct MorecFrame {
    /**
     * Set to `sizeof(MorecFrame)`.
     */
    size_t struct_size;
    /**
     * Time of the frame, seconds on any clock that does not go back; at any rate, even or uneven. Late and duplicate frames
     * are left out; after a gap of more than half a second, or a step back by as much, the stream begins anew.
     */
    double time_secs;
    /**
     * Number of joints: that of the skeleton; `MOREC_ROLE_COUNT` for a stream of roles.
     */
    size_t joint_count;
    /**
     * `joint_count` times x, y, z, or null. For a stream of roles: in the order of `MorecRole`.
     */
    const double *positions;
    /**
     * `joint_count` times x, y, z, w, or null; of any length but 0.
     */
    const double *rotations;
    /**
     * A `MorecSpace`.
     */
    int32_t space;
    /**
     * Must be 0.
     */
    uint32_t reserved;
} MorecFrame;

/**
 * Something said of a motion. Times are seconds on the clock of the frames, if not said otherwise.
 */
typedef struct MorecEvent {
    /**
     * A `MorecPhase`.
     */
    int32_t phase;
    /**
     * Its class in the index, certain or assumed.
     */
    uint32_t class_id;
    /**
     * Number of the motion, from 1: its start, updates and end share it.
     */
    uint64_t motion;
    /**
     * Number of the event, from 1. A gap would be a lost event, and be counted in `MorecStats.lost_events`.
     */
    uint64_t sequence;
    /**
     * Probability that the motion is right, 0 to 1: a just accepted one has 0.05 to 0.44, by the kind of index. Of held poses and
     * of indexes without calibration (svrdm, older ones) it is the closeness to a sample instead. Of a tentative event: how near
     * what was seen so far is to the beginning of a sample, 0 to 1.
     */
    double score;
    /**
     * Share of the motion seen so far, 0 to 1; 1 at its end.
     */
    double progress;
    /**
     * Start, seconds of the stream.
     */
    double start_secs;
    /**
     * Stop, seconds of the stream; if it has not ended, the time at which it was last seen.
     */
    double stop_secs;
    /**
     * The time of the frame that settled it.
     */
    double reported_secs;
    /**
     * Wall clock when that frame was pushed: seconds since 1970, UTC.
     */
    double wall_secs;
    /**
     * Repetitions of an activity so far; 0 where nothing is counted.
     */
    uint32_t repetitions;
    /**
     * Duration of one, as it was last.
     */
    double period_secs;
    /**
     * With `MOREC_DEVIATION`: mean angle between its bones and those of the nearest sample, degrees; -1 where nothing is compared. (Not in
     * the first version.)
     */
    double off_degrees;
    /**
     * Its duration over the sample's, so far; 0 where nothing is compared.
     */
    double pace;
    /**
     * Number of the bone that is farthest off: see `morec_bone_name`.
     */
    uint32_t worst_bone;
    /**
     * The largest angle of that bone, degrees.
     */
    double worst_degrees;
} MorecEvent;

/**
 * Counts of a recogniser since it was made or reset.
 */
typedef struct MorecStats {
    /**
     * Set to `sizeof(MorecStats)` before the call.
     */
    size_t struct_size;
    /**
     * Frames taken.
     */
    uint64_t frames;
    /**
     * Frames refused because events waited to be polled (`MOREC_STATUS_QUEUE_FULL`).
     */
    uint64_t refused_frames;
    /**
     * Events produced so far, polled or queued.
     */
    uint64_t events;
    /**
     * Events for which there was no room in the queue. Frames are refused before that happens: 0.
     */
    uint64_t lost_events;
    /**
     * Motions not reported because of `refractory_secs`.
     */
    uint64_t suppressed_motions;
    /**
     * From the end of a motion to its event at the earliest, on the clock of the frames.
     */
    double latency_secs;
} MorecStats;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Fills in `*diagnosis`, whose `struct_size` must be set, with what is known of the stream so far. Takes no memory.
 *
 * # Safety
 * `diagnosis` is null or points to a struct of the size it says.
 */
MorecStatus morec_recognizer_diagnosis(const struct MorecRecognizer *recognizer, struct MorecDiagnosis *diagnosis);

/**
 * Puts what is wrong with the stream into the `size` bytes at `buffer`, a sentence with what to do on each line, the
 * gravest first, with a zero at the end; an empty text if nothing is. If `needed` is not null, the bytes that takes are
 * put there. With too little room the text is cut and the status `MOREC_STATUS_BUFFER_TOO_SMALL`.
 *
 * # Safety
 * `buffer` is null or may be written to for `size` bytes; `needed` is null or may be written to.
 */
MorecStatus morec_recognizer_diagnosis_text(const struct MorecRecognizer *recognizer,
                                            char *buffer,
                                            size_t size,
                                            size_t *needed);

/**
 * Initialises the library with an index file, which `morec train` wrote; `szClassifierFile` is UTF-8.
 *
 * # Safety
 * `szClassifierFile` is null or ends with a zero.
 */
bool mrInit(const char *szClassifierFile);

/**
 * Ends whatever goes on and lets go of everything. Never fails; the speed of the source is 1 again.
 */
void mrTerminate(void);

/**
 * Takes the clip in a file (BVH; AMC with its ASF beside it) as the source of motion. Of several people in one file,
 * the first. `szSourceFile` is UTF-8.
 *
 * It is played frame by frame, in the time it took to perform. It begins when recognition does, so that nothing of it
 * is missed.
 *
 * # Safety
 * `szSourceFile` is null or ends with a zero.
 */
bool mrSetDataSource(const char *szSourceFile);

/**
 * Sets how fast sources are played from now on, also while they are: 1 as they were performed, 2 twice as fast, infinity as
 * fast as recognition goes. Not one of the eight.
 */
bool mrSetDataSourceSpeed(double speed);

/**
 * Stops the source: no further frame comes from it. What has come is still recognised.
 */
bool mrStopDataSource(void);

/**
 * True if nothing more will come from the source: it has played to its end or was stopped, or there is none.
 */
bool mrIsDataSourceDepleted(void);

/**
 * Starts recognition of the source, in threads of its own; a source that was played before begins anew.
 */
bool mrStart(void);

/**
 * Stops recognition, once everything that has come from the source is recognised. The solution remains.
 */
bool mrStop(void);

/**
 * Gives the solution so far: the last motions that were recognised since `mrStart`, at most `*nSegments`, in the order
 * of time. `*nSegments` becomes their number.
 *
 * A motion stays in the solution: `number` shows which are new. Of more than 16384 the last are kept. If
 * `pSegments` is null, `*nSegments` becomes the number of all that are kept.
 *
 * # Safety
 * `pSegments` is null or has room for `*nSegments`; `nSegments` is null or may be read and written.
 */
bool mrQueryMotionSegments(struct MotionSeg *pSegments, int *nSegments);

/**
 * Writes the name of a bone (`MorecEvent.worst_bone`), such as `left_forearm`, with a zero at the end.
 *
 * `*needed`, if `needed` is not null, becomes the number of bytes that takes, with the zero. If `size` is less, the
 * characters that fit are written with a zero, and the status is `MOREC_STATUS_BUFFER_TOO_SMALL`.
 *
 * # Safety
 * `buffer` is null or may be written to for `size` bytes; `needed` is null or may be written to.
 */
MorecStatus morec_bone_name(uint32_t bone, char *buffer, size_t size, size_t *needed);

/**
 * Loads an index from a file that `morec train` wrote. `path` is UTF-8.
 *
 * Puts the handle into `*index`, to be given back with `morec_index_destroy`.
 *
 * # Safety
 * `path` is null or ends with a zero; `index` is null or may be written to.
 */
MorecStatus morec_index_load(const char *path, struct MorecIndex **index);

/**
 * Loads an index from the bytes of such a file. They are not needed after the call.
 *
 * # Safety
 * `bytes` is null or points to `size` bytes; `index` is null or may be written to.
 */
MorecStatus morec_index_from_memory(const uint8_t *bytes, size_t size, struct MorecIndex **index);

/**
 * Gives an index back. Recognisers that were made of it go on.
 */
MorecStatus morec_index_destroy(struct MorecIndex *index);

/**
 * Fills in `*facts`, whose `struct_size` must be set.
 *
 * # Safety
 * `facts` is null or points to a struct of the size it says.
 */
MorecStatus morec_index_facts(const struct MorecIndex *index, struct MorecIndexFacts *facts);

/**
 * Writes the name of class `class_id` and a zero into the `size` bytes at `buffer`. UTF-8.
 *
 * `*needed`, if `needed` is not null, becomes the number of bytes that takes, with the zero. If `size` is less, the
 * characters that fit are written with a zero, and the status is `MOREC_STATUS_BUFFER_TOO_SMALL`. With a `size` of 0,
 * `buffer` may be null.
 *
 * # Safety
 * `buffer` is null or may be written to for `size` bytes; `needed` is null or may be written to.
 */
MorecStatus morec_index_class_name(const struct MorecIndex *index,
                                   uint32_t class_id,
                                   char *buffer,
                                   size_t size,
                                   size_t *needed);

/**
 * Makes a recogniser of one performer's motions and puts its handle into `*recognizer`, to be given back with
 * `morec_recognizer_destroy`. Takes memory; may take some milliseconds.
 *
 * # Safety
 * `options` is null or as its fields say; `recognizer` is null or may be written to.
 */
MorecStatus morec_recognizer_create(const struct MorecIndex *index,
                                    const struct MorecOptions *options,
                                    struct MorecRecognizer **recognizer);

/**
 * Gives a recogniser back. Events that wait are gone. A call that is under way on another thread ends well.
 */
MorecStatus morec_recognizer_destroy(struct MorecRecognizer *recognizer);

/**
 * Puts the joint that plays the `MorecRole` `role` into `*joint`, or −1 if none does.
 *
 * # Safety
 * `joint` is null or may be written to.
 */
MorecStatus morec_recognizer_joint_of_role(const struct MorecRecognizer *recognizer, int32_t role, int32_t *joint);

/**
 * Takes a frame. What it settles waits to be polled. Takes no memory after the first frame, unless it fails, or a second of frames shows
 * other joints than were declared.
 *
 * Refused with `MOREC_STATUS_QUEUE_FULL` while too many events wait for there to be room for what it settles:
 * nothing is ever lost.
 *
 * # Safety
 * `frame` is null or as its fields say.
 */
MorecStatus morec_recognizer_push(struct MorecRecognizer *recognizer,
                                  const struct MorecFrame *frame);

/**
 * Moves events that wait into the `capacity` places at `events`, the oldest first, and says in `*count` how many.
 *
 * `event_size` is `sizeof(MorecEvent)`: how far the places lie apart. If `*count` is `capacity`, more may wait. With a
 * `capacity` of 0, `events` may be null, and the status is `MOREC_STATUS_BUFFER_TOO_SMALL` if any wait.
 *
 * # Safety
 * `events` is null or may be written to for `capacity` times `event_size` bytes; `count` is null or may be written to.
 */
MorecStatus morec_recognizer_poll(struct MorecRecognizer *recognizer,
                                  struct MorecEvent *events,
                                  size_t event_size,
                                  size_t capacity,
                                  size_t *count);

/**
 * Ends the stream: what its last moments hold waits to be polled. The next frame begins a new stream.
 *
 * Refused with `MOREC_STATUS_QUEUE_FULL` as a frame would be.
 */
MorecStatus morec_recognizer_finish(struct MorecRecognizer *recognizer);

/**
 * Makes the recogniser as it was when it was made: the stream so far, events that wait, and counts are forgotten.
 */
MorecStatus morec_recognizer_reset(struct MorecRecognizer *recognizer);

/**
 * Fills in `*stats`, whose `struct_size` must be set. May be called from any thread at any time.
 *
 * # Safety
 * `stats` is null or points to a struct of the size it says.
 */
MorecStatus morec_recognizer_stats(const struct MorecRecognizer *recognizer, struct MorecStats *stats);

/**
 * Message of the last call on this thread that failed, a sentence; empty if none has failed yet.
 * UTF-8. The text stays where it is until the next call on this thread that does not succeed. Never null.
 */
const char *morec_last_error(void);

/**
 * Meaning of a status in a few words; null for a number that is no status. The text lives for ever.
 */
const char *morec_status_text(int32_t status);

/**
 * Version of the library, as in `0.1.0`. The text stays for ever.
 */
const char *morec_version(void);

/**
 * The name of a `MorecRole` or a point of a hand or of a custom skeleton, as in `left_forearm`, `right_index_tip` and `point_1`; null for a number without a name. The text stays for ever.
 */
const char *morec_role_name(int32_t role);

/**
 * The `MorecRole` of this name, or the number of a point of a hand or of a custom skeleton; `MOREC_ROLE_NONE` if there is none, or `name` is null.
 *
 * # Safety
 * `name` is null or ends with a zero.
 */
int32_t morec_role_from_name(const char *name);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MOREC_H */

#if defined(__cplusplus) && !defined(MOREC_LISTING_4_1)
#define MOREC_LISTING_4_1
/** `mrQueryMotionSegments` with the number by reference, as Listing 4.1 has it. */
inline bool mrQueryMotionSegments(MotionSeg *pSegments, int &nSegments) {
    return mrQueryMotionSegments(pSegments, &nSegments);
}
#endif
