/* Recognises motions in a stream of poses, as it comes.
 *
 *     stream INDEX < poses.txt
 *
 * Every line of poses.txt is one pose: the time in seconds, then x y z of every role in the order of MorecRole, right-
 * handed and Y up; nan where a role is not seen. A line of output is one motion.
 *
 * C99, and C++ as well.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "morec.h"

enum { COORDINATES = 3 * MOREC_ROLE_COUNT, EVENTS = 32 };

static int failed(const char *what) {
    fprintf(stderr, "%s: %s\n", what, morec_last_error());
    return 0;
}

/* Prints what has been recognised since it was last asked. */
static int print_events(const MorecIndex *index, MorecRecognizer *recognizer) {
    MorecEvent events[EVENTS];
    size_t count, i;
    do {
        if (morec_recognizer_poll(recognizer, events, sizeof events[0], EVENTS, &count) != MOREC_STATUS_OK)
            return failed("poll");
        for (i = 0; i < count; i++) {
            char name[128];
            morec_index_class_name(index, events[i].class_id, name, sizeof name, NULL);
            printf("%s %.4f %.4f %.4f\n", name, events[i].start_secs, events[i].stop_secs, events[i].score);
        }
    } while (count == EVENTS);
    return 1;
}

/* Reads the next pose; 0 at the end of the input. */
static int read_pose(double *time_secs, double *positions) {
    int i;
    if (scanf("%lf", time_secs) != 1)
        return 0;
    for (i = 0; i < COORDINATES; i++)
        if (scanf("%lf", &positions[i]) != 1)
            return 0;
    return 1;
}

static int recognise(const MorecIndex *index, MorecRecognizer *recognizer) {
    double positions[COORDINATES];
    MorecFrame frame;
    memset(&frame, 0, sizeof frame);
    frame.struct_size = sizeof frame;
    frame.space = MOREC_SPACE_WORLD;
    frame.joint_count = MOREC_ROLE_COUNT;
    frame.positions = positions;
    while (read_pose(&frame.time_secs, positions)) {
        if (morec_recognizer_push(recognizer, &frame) != MOREC_STATUS_OK)
            return failed("push");
        if (!print_events(index, recognizer))
            return 0;
    }
    /* What the last moments hold. */
    if (morec_recognizer_finish(recognizer) != MOREC_STATUS_OK)
        return failed("finish");
    return print_events(index, recognizer);
}

int main(int argc, char **argv) {
    MorecIndex *index;
    MorecRecognizer *recognizer;
    MorecOptions options;
    int done;
    if (argc != 2) {
        fprintf(stderr, "usage: stream INDEX < poses.txt\n");
        return 2;
    }
    if (morec_index_load(argv[1], &index) != MOREC_STATUS_OK) {
        failed("index");
        return EXIT_FAILURE;
    }
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    options.handedness = MOREC_HANDEDNESS_RIGHT;
    options.up_axis = MOREC_UP_AXIS_Y;
    if (morec_recognizer_create(index, &options, &recognizer) != MOREC_STATUS_OK) {
        failed("recogniser");
        morec_index_destroy(index);
        return EXIT_FAILURE;
    }
    done = recognise(index, recognizer);
    morec_recognizer_destroy(recognizer);
    morec_index_destroy(index);
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}
