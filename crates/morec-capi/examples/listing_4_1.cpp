// Listing 4.1 of Bucur 2009, "Typical application using MoRec", between a beginning and an end that make it a program.
//
//     listing_4_1 INDEX CLIP [SPEED]
//
// SPEED is 1 as it was performed, inf as fast as it goes.
#include <cstdio>
#include <cstdlib>

#include "morec.h"

static const int MAX_TEST_SEGS = 64;
static bool finished = false;

static void application(char *szClassifier, char *szSource) {
    MotionSeg pTestSegs[MAX_TEST_SEGS];
    int nTestSegs;

    /* ... Other initialization code ... */

    if( !mrInit(szClassifier)          || //Init MoRec library
          !mrSetDataSource(szSource)    || //Init data source
          !mrStart())                  //Start recognition
      return; //Error!

    //Game loop
    while(!mrIsDataSourceDepleted())
    {
      //Periodically query for segmentation results
      nTestSegs = MAX_TEST_SEGS;
      mrQueryMotionSegments(pTestSegs, nTestSegs);

      /* ... Do other game specific updates ... */
    }

    if( !mrStopDataSource() || //Stop the data source
          !mrStop())           //Stop recognition
      return; //Error!

    // Not in the listing: what was recognised of the last frames, too.
    nTestSegs = MAX_TEST_SEGS;
    if (!mrQueryMotionSegments(pTestSegs, nTestSegs))
        return;
    for (int i = 0; i < nTestSegs; i++)
        std::printf("%s %.4f %.4f %.4f\n", pTestSegs[i].class_name, pTestSegs[i].start_secs, pTestSegs[i].stop_secs,
                    pTestSegs[i].confidence);
    finished = true;

    //Free memory
    mrTerminate();

    /* ... Other termination code ... */
}

int main(int argc, char **argv) {
    if (argc < 3 || argc > 4) {
        std::fprintf(stderr, "usage: listing_4_1 INDEX CLIP [SPEED]\n");
        return 2;
    }
    if (argc == 4 && !mrSetDataSourceSpeed(std::atof(argv[3]))) {
        std::fprintf(stderr, "speed: %s\n", morec_last_error());
        return 2;
    }
    application(argv[1], argv[2]);
    if (!finished)
        std::fprintf(stderr, "%s\n", morec_last_error());
    mrTerminate();
    return finished ? EXIT_SUCCESS : EXIT_FAILURE;
}
