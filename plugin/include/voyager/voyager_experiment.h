/* Choices for measurements, in C99: ways to find a cut, to draw splats and to choose detail that
 * the library is compared with. An engine needs none of them.
 *
 * This header is outside the promise of voyager.h. Any minor version may change or remove what it
 * declares, so build such a program against the version of the library that it runs with. A
 * structure that changes gets another number, so that the old one is refused. */
#ifndef VOYAGER_VOYAGER_EXPERIMENT_H_
#define VOYAGER_VOYAGER_EXPERIMENT_H_

#include <voyager/voyager.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How the cut is found. All searches find the same cut, to the bit. They differ in what they
 * read. */
typedef enum VoySearch {
  VOY_SEARCH_AUTO = 0,           /* TEMPORAL, or SWEEP where that is faster */
  VOY_SEARCH_EXHAUSTIVE = 1,     /* tests every node: the baseline. Not for streamed scenes */
  VOY_SEARCH_STREAMING = 2,      /* reads chunks from the top and skips those below the cut */
  VOY_SEARCH_TEMPORAL = 3,       /* starts from the view's last cut and tests what may have changed.
                                    Falls back to STREAMING for a view's first frame, and where that
                                    is cheaper */
  VOY_SEARCH_TEMPORAL_VISIT = 4, /* TEMPORAL, but visits all of the last cut */
  VOY_SEARCH_SWEEP = 5,          /* tests every node that has children, in one pass; a jump costs no
                                    more than a step. On CUDA, of a scene that is resident, without
                                    damage, and whose leaves have no extent, as all that this version
                                    bakes; TEMPORAL runs elsewhere. Not for streamed scenes */
  VOY_SEARCH_MAX_ENUM = 0x7fffffff
} VoySearch;

/* How the exponential in a splat's alpha is computed (docs/numerics.md has the errors). */
typedef enum VoyExponential {
  VOY_EXPONENTIAL_AUTO = 0,  /* EX2 on CUDA with VOY_SPLATTING_OURS, else EXACT */
  VOY_EXPONENTIAL_EXACT = 1, /* within 2 ulp */
  VOY_EXPONENTIAL_EX2 = 2,   /* base 2, with log2(e) folded into the conic */
  VOY_EXPONENTIAL_LUT = 3,   /* the nearest entry of a table of lutSize + 1 entries */
  VOY_EXPONENTIAL_HALF2 = 4, /* CUDA only: EX2 and blending in binary16, about 60 dB PSNR */
  VOY_EXPONENTIAL_MAX_ENUM = 0x7fffffff
} VoyExponential;

/* Whether (tile, splat) pairs that cannot reach the alpha threshold are dropped before sorting. */
typedef enum VoyAlphaFilter {
  VOY_ALPHA_FILTER_ON = 0,
  VOY_ALPHA_FILTER_OFF = 1, /* the same image, to the bit, but slower */
  VOY_ALPHA_FILTER_MAX_ENUM = 0x7fffffff
} VoyAlphaFilter;

/* How splats become pixels (docs/splatting.md). */
typedef enum VoySplatting {
  VOY_SPLATTING_OURS = 0, /* bins a splat into the tiles that its α-threshold ellipse touches */
  VOY_SPLATTING_3DGS = 1, /* CUDA only, the baseline: 3-sigma boxes, (tile, depth) keys, expf, one
                             thread for each pixel. It draws one eye, into host memory or with HOST
                             sharing, without a depth limit */
  VOY_SPLATTING_MAX_ENUM = 0x7fffffff
} VoySplatting;

/* Which nodes of a tree are drawn (docs/lod-selection.md). The baselines draw without
 * interpolation, and no streamed scene. */
typedef enum VoySelection {
  VOY_SELECTION_CUT = 0,    /* as VoyViewDesc.lod says */
  VOY_SELECTION_BLOCKS = 1, /* as CityGaussian: one depth of the tree for each block of the scene,
                               chosen by the distance of the block */
  VOY_SELECTION_LEVELS = 2, /* as Octree-GS: a node's level is log2 of its extent, rounded up, and
                               is compared with the level that its distance asks for */
  VOY_SELECTION_MAX_ENUM = 0x7fffffff
} VoySelection;

/* In VoyViewDesc.next: how the view draws. Any minor version may change it, as it may all of this
 * header.
 * Further errors of voyCreateView: INVALID_ARGUMENT (a value out of range; a baseline of selection
 * with VOY_LOD_ALL_LEAVES), UNSUPPORTED (a choice that VoyExperimentCapabilities does not list). */
typedef struct VoyExperiment {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_EXPERIMENT */
  const void* next;
  VoySelection selection;     /* with VOY_LOD_ALL_LEAVES only CUT */
  VoySearch search;           /* one of VoyExperimentCapabilities.searches */
  VoyAlphaFilter alphaFilter; /* of VOY_SPLATTING_OURS */
  VoyExponential exponential; /* one of VoyExperimentCapabilities.exponentials */
  uint32_t lutSize;           /* intervals of VOY_EXPONENTIAL_LUT, 1 to 4096; 0: 32 */
  VoySplatting splatting;     /* one of VoyExperimentCapabilities.splattings */
  /* 1: an alpha threshold of 1e-4, for the samples of pictures that others are judged by. It needs
   * VOY_ANTIALIAS_ON and EXACT or EX2, and is slower. 0: 1/255 */
  uint32_t truth;
  uint32_t reserved; /* 0 */
} VoyExperiment;
/* As a view without a VoyExperiment draws. */
#define VOY_EXPERIMENT_INIT                                                                       \
  {                                                                                               \
    VOY_STRUCTURE_TYPE_EXPERIMENT, NULL, VOY_SELECTION_CUT, VOY_SEARCH_AUTO, VOY_ALPHA_FILTER_ON, \
        VOY_EXPONENTIAL_AUTO, 0, VOY_SPLATTING_OURS, 0, 0                                         \
  }

/* In VoyCapabilities.next: what a VoyExperiment may ask for on the device. In the bit masks, bit
 * 1 << e stands for the value e of the enum. */
typedef struct VoyExperimentCapabilities {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_EXPERIMENT_CAPABILITIES */
  void* next;
  uint32_t searches;     /* bit mask of VoySearch */
  uint32_t exponentials; /* bit mask of VoyExponential */
  uint32_t splattings;   /* bit mask of VoySplatting */
  uint32_t reserved;     /* 0 */
} VoyExperimentCapabilities;
#define VOY_EXPERIMENT_CAPABILITIES_INIT \
  { VOY_STRUCTURE_TYPE_EXPERIMENT_CAPABILITIES, NULL, 0, 0, 0, 0 }

/* In VoyFrameStats.next. */
typedef struct VoyExperimentStats {
  VoyStructureType type; /* VOY_STRUCTURE_TYPE_EXPERIMENT_STATS */
  void* next;
  VoySearch search;     /* the search that ran for the first instance with a cut: STREAMING where
                           TEMPORAL fell back to it. AUTO if no instance has a cut */
  uint32_t redrawCount; /* how often CUDA drew the frame again, because a buffer was too small.
                           "project" includes the time of what was drawn before */
} VoyExperimentStats;
#define VOY_EXPERIMENT_STATS_INIT \
  { VOY_STRUCTURE_TYPE_EXPERIMENT_STATS, NULL, VOY_SEARCH_AUTO, 0 }

#ifdef __cplusplus
}
#endif

#endif
