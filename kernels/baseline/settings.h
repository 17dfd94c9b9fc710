// What kernels/baseline/simulate.cl needs in one step, read by C++ (after kernels/shared.h, which has float4) and by
// the kernel.
#ifndef COIF_BASELINE_SETTINGS_H
#define COIF_BASELINE_SETTINGS_H
#ifdef __cplusplus
namespace coif::study
{
#endif

typedef struct BaselineSettings
{
    float4 scalp;        // its centre in the world at the end of the step, m
    float duration;      // of the step, s
    float drag_keep;     // exp(-drag h)
    float push;          // gravity's, in the first step half: drag's integral times gravity, m/s along y
    float stretching;    // of a sweep, eq. 5.5
    float bending_scale; // of the distances that bending keeps
    int iterations;
    int spheres;
} BaselineSettings;

#ifdef __cplusplus
} // namespace coif::study
#endif
#endif
