/* morec: recognise motions live. The manual is README.md of morec-capi.
 *
 * Made from the sources of morec-capi; `MOREC_WRITE_HEADER=1 cargo test -p morec-capi header` makes it again.
 *
 * Each handle is released once, with the destroy function of its type. Null, foreign and destroyed handles, null and misaligned
 * pointers, and invalid values are refused with a status; the memory behind any other pointer must be as the function describes.
 * An index may be used by any number of threads at once. One thread may push into a recogniser while another polls it. A call
 * that collides with the same call on another thread is refused with MOREC_STATUS_BUSY and changes nothing. Different recognisers
 * are independent. There are no callbacks, and no morec_ function starts a thread.
 */

#ifndef MOREC_H
#define MOREC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/**
 * Also report motions before they end: events of the phases start, update and cancel.
 */
#define MOREC_TENTATIVE 1

/**
 * Any performer: the score threshold is never raised. For hands, tracked points and older indexes, matching is relaxed from the
 * first frame, not only after motions of a performer unlike the training subject.
 */
#define MOREC_PERFORMER_ANYONE 2

/**
 * The performer is the training subject: the score threshold is raised from the first frame, by the scores of the training
 * samples.
 */
#define MOREC_PERFORMER_TEACHER 4

/**
 * Report each repetition of an activity as an event of its own.
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
 * Number of body parts; they are numbered from 0.
 */
#define MOREC_ROLE_COUNT 18

/**
 * Number of body parts, points of both hands, points of a custom skeleton and `face` together; they are numbered from 0.
 */
#define MOREC_POINT_COUNT 85

/**
 * Result of a call. Values never change; later versions may add new ones.
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
     * An invalid handle: never created, of another type, or destroyed.
     */
    MOREC_STATUS_BAD_HANDLE = 2,
    /**
     * Invalid value; no change.
     */
    MOREC_STATUS_INVALID_VALUE = 3,
    /**
     * The buffer is too small for the answer; the function returns the needed size as documented there.
     */
    MOREC_STATUS_BUFFER_TOO_SMALL = 4,
    /**
     * Another thread is using this recogniser; nothing was changed.
     */
    MOREC_STATUS_BUSY = 5,
    /**
     * The event queue is full, so the frame was not processed. Poll events, then push the frame again.
     */
    MOREC_STATUS_QUEUE_FULL = 6,
    /**
     * A file cannot be read.
     */
    MOREC_STATUS_FILE = 7,
    /**
     * The bytes are not an index that this release can read.
     */
    MOREC_STATUS_BAD_INDEX = 8,
    /**
     * The index and the stream have no bone in common.
     */
    MOREC_STATUS_NOTHING_IN_COMMON = 9,
    /**
     * Another call must come first.
     */
    MOREC_STATUS_WRONG_ORDER = 10,
    /**
     * A struct is smaller than its first version, or has fields set that this release does not know.
     */
    MOREC_STATUS_STRUCT_SIZE = 11,
    /**
     * An internal error of morec. Destroy the handle, and please report the error.
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
 * A body part, named for the joint at its near end: the hip joint has the role thigh, the knee shin, the wrist hand. Torso is
 * the first joint of the spine above the hips.
 */
enum MorecRole
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * No role: a joint that recognition does not use.
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
     * The world: `positions` are required; `rotations` turn the joints' axes into the world's.
     */
    MOREC_SPACE_WORLD = 1,
    /**
     * The parent's frame: `rotations` are required; `positions` replace the skeleton's offsets. A root's are in the world.
     * Requires a skeleton.
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
     * A motion has probably started. Tentative; only with `MOREC_TENTATIVE`.
     */
    MOREC_PHASE_START = 0,
    /**
     * The progress or the probable class has changed. Tentative.
     */
    MOREC_PHASE_UPDATE = 1,
    /**
     * The motion that a start event announced was not confirmed.
     */
    MOREC_PHASE_CANCEL = 2,
    /**
     * The motion has ended. Final: an end is never revoked, and every motion ends once.
     */
    MOREC_PHASE_END = 3,
    /**
     * A repetition of an activity is complete, from the event's start to its stop; `repetitions` is its number. Only with
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
     * Templates of joint positions, matched elastically in time.
     */
    MOREC_METHOD_TEMPLATES = 0,
    /**
     * The method of 2009, on joint rotations.
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
 * A loaded index. It does not change; any number of threads may use it at once.
 */
typedef struct MorecIndex MorecIndex;

/**
 * A recogniser of one performer's motions.
 */
typedef struct MorecRecognizer MorecRecognizer;

/**
 * Measures of a stream. Unknown measures are NaN. Lengths are in metres, converted from the inferred unit of the stream.
 */
typedef struct MorecDiagnosis {
    /**
     * Set to `sizeof(MorecDiagnosis)` before the call.
     */
    size_t struct_size;
    /**
     * Number of frames examined.
     */
    uint64_t frames;
    /**
     * `MorecFinding` bits; 0 during about the first second of the stream.
     */
    uint32_t findings;
    /**
     * `MorecSeverity` of the most severe finding.
     */
    int32_t severity;
    /**
     * Bit `r` for each `MorecRole` `r` that is always missing.
     */
    uint32_t missing_roles;
    /**
     * Bit `r` for each `MorecRole` `r` that is missing in some frames.
     */
    uint32_t flickering_roles;
    /**
     * Time from the first frame to the last, seconds.
     */
    double secs;
    /**
     * Frames a second.
     */
    double rate_hz;
    /**
     * Half the range of 90 % of the intervals between arrivals of frames, seconds.
     */
    double jitter_secs;
    /**
     * Share of the expected frames that did not arrive, 0 to 1.
     */
    double lost_share;
    /**
     * Share of the frames that repeat the previous frame, 0 to 1.
     */
    double repeated_share;
    /**
     * Share of the frames without a body, 0 to 1.
     */
    double empty_share;
    /**
     * Length from the ankles to the head joint along the bones, metres.
     */
    double height_m;
    /**
     * Length of thigh and shin, metres.
     */
    double leg_m;
    /**
     * Angle between a standing body, or the trunk, and the vertical, radians.
     */
    double tilt_rad;
    /**
     * Standard deviation of fast noise on each coordinate, metres.
     */
    double noise_m;
    /**
     * Share of the frames in which a joint jumps far away, 0 to 1.
     */
    double spike_share;
} MorecDiagnosis;

/**
 * A recognised motion: a segment of the stream and its class.
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
     * First frame of the motion in the clip.
     */
    uint32_t start_frame;
    /**
     * Frame of the clip after the motion's last frame.
     */
    uint32_t stop_frame;
    /**
     * Length of `class_name` in bytes, without the zero.
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
     * Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the index. For
     * held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead.
     */
    double confidence;
    /**
     * Name of its class, UTF-8, zero-terminated; truncated if it is longer.
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
     * Body parts that recognition uses: bit `r` for `MorecRole` `r`. If a stream lacks some, the others are compared.
     */
    uint32_t roles;
    /**
     * Number of training samples.
     */
    uint64_t sample_count;
    /**
     * Comparisons with the templates a second.
     */
    double tick_hz;
    /**
     * Method of recognition, a `MorecMethod`; later releases may add values. Not in the first version of this struct.
     */
    int32_t method;
    /**
     * 1 if frames must have joint rotations, 0 if positions are enough. Not in the first version of this struct.
     */
    uint32_t needs_rotations;
} MorecIndexFacts;

/**
 * The joints of a stream's skeleton. Everything is copied; nothing is used after the call returns.
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
     * `joint_count` numbers: each joint's parent, which must come before it, or −1 for a root.
     */
    const int32_t *parents;
    /**
     * `joint_count` names, UTF-8, or null. If `roles` is null, roles are inferred from them. Joints without parents may be
     * landmarks or points of hands.
     */
    const char *const *names;
    /**
     * `joint_count` times x, y, z: the joint's position in its parent's frame; or null if every frame has positions.
     */
    const double *offsets;
    /**
     * `joint_count` values of `MorecRole`, `MOREC_ROLE_NONE` for most joints; or null: inferred from the tree and the names.
     * Points of hands (`left_palm`, `left_thumb_1` … `right_little_tip`), points of a custom skeleton and `face` have the
     * numbers from `MOREC_ROLE_COUNT` to below `MOREC_POINT_COUNT`; see `morec_role_from_name`.
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
     * A `MorecHandedness`; required.
     */
    int32_t handedness;
    /**
     * A `MorecUpAxis`.
     */
    int32_t up_axis;
    /**
     * The stream's joints; null for a stream of roles, in which joint `r` has the `MorecRole` `r`.
     */
    const struct MorecSkeleton *skeleton;
    /**
     * For a stream of roles: bit `r` for each `MorecRole` `r` that it contains; 0 for all.
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
     * Least time between two reports of the same class, seconds; suppressed motions are counted. 0: every motion is reported
     * once.
     */
    double refractory_secs;
    /**
     * Sensitivity: accepted false alarms a minute in background motion; 0.1 is strict, 1 is generous. 0: as trained. (Not in the
     * first version of this struct.)
     */
    double sensitivity;
} MorecOptions;

/**
 * One performer's pose at one instant. Nothing of it is used after the call returns.
 *
 * A missing joint has a position of NaN, or in local space a rotation of NaN. In local space, a position of NaN means the
 * skeleton's offset. Lengths may have any unit, the same in all frames; metres are best.
 */
typedef struct MorecFrame {
    /**
     * Set to `sizeof(MorecFrame)`.
     */
    size_t struct_size;
    /**
     * Time of the frame, seconds on any clock that does not go back, at any regular or irregular rate. Late and duplicate frames
     * are ignored; after a gap or a step back of more than 0.5 s, the stream starts again.
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
     * Quaternions: `joint_count` times x, y, z, w, of any length but 0; or null.
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
 * An event of a motion. Times are seconds on the clock of the frames unless stated otherwise.
 */
typedef struct MorecEvent {
    /**
     * A `MorecPhase`.
     */
    int32_t phase;
    /**
     * Class in the index, from 0; tentative before the end.
     */
    uint32_t class_id;
    /**
     * Number of the motion, from 1: its start, updates and end share it.
     */
    uint64_t motion;
    /**
     * Number of the event, from 1. A gap means a lost event, which is counted in `MorecStats.lost_events`.
     */
    uint64_t sequence;
    /**
     * Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the index. For
     * held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead. Of a tentative
     * event: how near what was seen so far is to the beginning of a sample, 0 to 1.
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
     * Stop, seconds of the stream; for a motion that has not ended, the time of its latest frame.
     */
    double stop_secs;
    /**
     * Time of the frame that caused the event, seconds of the stream.
     */
    double reported_secs;
    /**
     * Wall clock when this frame was pushed, seconds since 1970, UTC.
     */
    double wall_secs;
    /**
     * Repetitions of an activity so far; 0 if nothing is counted.
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
 * Counts of a recogniser since it was created or reset.
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
     * Frames refused because the event queue was full (`MOREC_STATUS_QUEUE_FULL`).
     */
    uint64_t refused_frames;
    /**
     * Events produced so far, polled or queued.
     */
    uint64_t events;
    /**
     * Events lost because the queue was full. Always 0, because frames are refused before that.
     */
    uint64_t lost_events;
    /**
     * Motions not reported because of `refractory_secs`.
     */
    uint64_t suppressed_motions;
    /**
     * Shortest time from the end of a motion to its event, seconds on the clock of the frames.
     */
    double latency_secs;
} MorecStats;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Fills in `*diagnosis`, whose `struct_size` must be set, with measures of the stream so far. Allocates no memory.
 *
 * # Safety
 * `diagnosis` is null or points to a struct of the size it says.
 */
MorecStatus morec_recognizer_diagnosis(const struct MorecRecognizer *recognizer, struct MorecDiagnosis *diagnosis);

/**
 * Writes the problems of the stream into the `size` bytes at `buffer`: one sentence with its remedy on each line, the most
 * severe first, zero-terminated. The text is empty if no problem is known. If `needed` is not null, it receives the number of bytes
 * needed. If the buffer is too small, the text is truncated and the status is `MOREC_STATUS_BUFFER_TOO_SMALL`.
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
 * Ends recognition and releases everything. Never fails; the speed of sources is reset to 1.
 */
void mrTerminate(void);

/**
 * Sets the clip in a file (BVH; AMC with its ASF in the same folder) as the source of motion; if the file has several people,
 * the first. `szSourceFile` is UTF-8.
 *
 * The clip is played frame by frame at the speed of the performance. It starts together with recognition, so that no frame is
 * missed.
 *
 * # Safety
 * `szSourceFile` is null or ends with a zero.
 */
bool mrSetDataSource(const char *szSourceFile);

/**
 * Sets the speed of sources, also while they are playing: 1 as performed, 2 twice as fast, infinity as fast as recognition can.
 * Not one of the eight functions of the thesis.
 */
bool mrSetDataSourceSpeed(double speed);

/**
 * Stops the source. Frames that it has already sent are still recognised.
 */
bool mrStopDataSource(void);

/**
 * True if the source will send no more frames: it has ended, was stopped, or is not set.
 */
bool mrIsDataSourceDepleted(void);

/**
 * Starts recognition of the source, in separate threads; a source that was played before starts again.
 */
bool mrStart(void);

/**
 * Stops recognition after all frames sent by the source have been recognised. The solution is kept.
 */
bool mrStop(void);

/**
 * Returns the solution so far: the last motions recognised since `mrStart`, at most `*nSegments`, in order of time. Sets
 * `*nSegments` to their number.
 *
 * Motions stay in the solution; `number` shows which are new. At most the last 16384 motions are kept. If `pSegments` is null,
 * `*nSegments` is set to the number of all kept motions.
 *
 * # Safety
 * `pSegments` is null or has room for `*nSegments`; `nSegments` is null or may be read and written.
 */
bool mrQueryMotionSegments(struct MotionSeg *pSegments,
                           int *nSegments);

/**
 * Writes the name of a bone (`MorecEvent.worst_bone`), such as `left_forearm`, with a zero at the end.
 *
 * If `needed` is not null, it receives the number of bytes needed, with the zero. If `size` is smaller, the text is truncated,
 * zero-terminated, and the status is `MOREC_STATUS_BUFFER_TOO_SMALL`.
 *
 * # Safety
 * `buffer` is null or may be written to for `size` bytes; `needed` is null or may be written to.
 */
MorecStatus morec_bone_name(uint32_t bone,
                            char *buffer,
                            size_t size,
                            size_t *needed);

/**
 * Loads an index from a file that `morec train` wrote. `path` is UTF-8.
 *
 * Writes the handle to `*index`; release it with `morec_index_destroy`.
 *
 * # Safety
 * `path` is null or ends with a zero; `index` is null or may be written to.
 */
MorecStatus morec_index_load(const char *path, struct MorecIndex **index);

/**
 * Loads an index from the bytes of such a file. The bytes are not used after the call returns.
 *
 * # Safety
 * `bytes` is null or points to `size` bytes; `index` is null or may be written to.
 */
MorecStatus morec_index_from_memory(const uint8_t *bytes, size_t size, struct MorecIndex **index);

/**
 * Releases an index. Recognisers made from it stay valid.
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
 * If `needed` is not null, it receives the number of bytes needed, with the zero. If `size` is smaller, the text is truncated,
 * zero-terminated, and the status is `MOREC_STATUS_BUFFER_TOO_SMALL`. With a `size` of 0, `buffer` may be null.
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
 * Creates a recogniser for one performer's motions and writes its handle to `*recognizer`; release it with
 * `morec_recognizer_destroy`. Allocates memory and may take some milliseconds.
 *
 * # Safety
 * `options` is null or as its fields say; `recognizer` is null or may be written to.
 */
MorecStatus morec_recognizer_create(const struct MorecIndex *index,
                                    const struct MorecOptions *options,
                                    struct MorecRecognizer **recognizer);

/**
 * Releases a recogniser and discards its queued events. A call running on another thread completes safely.
 */
MorecStatus morec_recognizer_destroy(struct MorecRecognizer *recognizer);

/**
 * Writes the number of the joint with the `MorecRole` `role` to `*joint`, or −1 if no joint has it.
 *
 * # Safety
 * `joint` is null or may be written to.
 */
MorecStatus morec_recognizer_joint_of_role(const struct MorecRecognizer *recognizer, int32_t role, int32_t *joint);

/**
 * Processes a frame and queues the events that it causes. Allocates no memory after the first frame, unless it fails or a second
 * of frames has other joints than declared.
 *
 * Refused with `MOREC_STATUS_QUEUE_FULL` if the queue might not have room for these events, so that none is ever lost.
 *
 * # Safety
 * `frame` is null or as its fields say.
 */
MorecStatus morec_recognizer_push(struct MorecRecognizer *recognizer,
                                  const struct MorecFrame *frame);

/**
 * Moves up to `capacity` queued events to `events`, the oldest first, and writes their number to `*count`.
 *
 * `event_size` is `sizeof(MorecEvent)`, the distance of the elements in bytes. If `*count` equals `capacity`, more events may be
 * queued. With a `capacity` of 0, `events` may be null, and the status is `MOREC_STATUS_BUFFER_TOO_SMALL` if any event is
 * queued.
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
 * Ends the stream and queues its last events. The next frame starts a new stream.
 *
 * Refused with `MOREC_STATUS_QUEUE_FULL` under the same condition as a frame.
 */
MorecStatus morec_recognizer_finish(struct MorecRecognizer *recognizer);

/**
 * Resets the recogniser to its initial state: discards the stream so far, queued events and counts.
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
 * Message of the last failed call on this thread, one sentence; empty if no call has failed.
 * UTF-8. The text is valid until the next failing call on this thread. Never null.
 */
const char *morec_last_error(void);

/**
 * Meaning of a status in a few words; null if the number is not a status. The text is valid for ever.
 */
const char *morec_status_text(int32_t status);

/**
 * Version of the library, such as `0.1.0`. The text is valid for ever.
 */
const char *morec_version(void);

/**
 * The name of a `MorecRole` or a point of a hand or of a custom skeleton, as in `left_forearm`, `right_index_tip` and `point_1`;
 * null for a number without a name. The text is valid for ever.
 */
const char *morec_role_name(int32_t role);

/**
 * The `MorecRole` of this name, or the number of a point of a hand or of a custom skeleton; `MOREC_ROLE_NONE` if there is no
 * such name, or `name` is null.
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
