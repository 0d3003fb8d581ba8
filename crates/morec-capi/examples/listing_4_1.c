/* Listing 4.1 of Bucur 2009, "Typical application using MoRec", in C: the number of segments goes by pointer. Motions
 * are printed as soon as they are recognised.
 *
 *     listing_4_1 INDEX CLIP [SPEED]
 *
 * SPEED is 1 as it was performed, inf as fast as it goes.
 */
#include <stdio.h>
#include <stdlib.h>

#include "morec.h"

enum { MAX_TEST_SEGS = 64 };

/* A motion stays in the solution: those with a number beyond the last one seen are new. */
static bool print_new(uint64_t *seen) {
    MotionSeg test_segs[MAX_TEST_SEGS];
    int count = MAX_TEST_SEGS, i;
    if (!mrQueryMotionSegments(test_segs, &count))
        return false;
    for (i = 0; i < count; i++) {
        const MotionSeg *seg = &test_segs[i];
        if (seg->number <= *seen)
            continue;
        *seen = seg->number;
        printf("%s %.4f %.4f %.4f\n", seg->class_name, seg->start_secs, seg->stop_secs, seg->confidence);
        fflush(stdout);
    }
    return true;
}

static bool application(const char *classifier, const char *source) {
    uint64_t seen = 0;
    if (!mrInit(classifier) || !mrSetDataSource(source) || !mrStart())
        return false;
    while (!mrIsDataSourceDepleted())
        if (!print_new(&seen))
            return false;
    return mrStopDataSource() && mrStop() && print_new(&seen);
}

int main(int argc, char **argv) {
    bool done;
    if (argc < 3 || argc > 4) {
        fprintf(stderr, "usage: listing_4_1 INDEX CLIP [SPEED]\n");
        return 2;
    }
    done = argc == 3 || mrSetDataSourceSpeed(atof(argv[3]));
    done = done && application(argv[1], argv[2]);
    if (!done)
        fprintf(stderr, "%s\n", morec_last_error());
    mrTerminate();
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}
