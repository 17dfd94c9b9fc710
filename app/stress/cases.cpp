#include "app/stress/cases.h"

namespace coif::stress
{

static const Case kCases[] = {
    {"frame-lengths", "0, negative and NaN take no step; 1e-5 to 1 s keep lengths; the rest of a long frame is dropped",
     frame_lengths},
    {"free-fall", "at 1e-5 s a step, hair falls with its head within 1 %", free_fall},
    {"gravity", "1e4 g: hangs along it, lengths kept", gravity},
    {"wind", "1e4 m/s^2: lies along it, lengths kept", wind},
    {"drag", "0 to 1e6 1/s: motion dies down monotonically", drag},
    {"iterations", "0 to 1000 sweeps or substeps: taken as the nearest that there is", iterations},
    {"stiffness", "below 0, 0, 1, above 1: taken as the nearest that there is; bounded without any", stiffness},
    {"no-length", "zero length, nodes upon each other, scale 0: no NaN", no_length},
    {"node-counts", "3 to 256 nodes", node_counts},
    {"strand-counts", "1 to 200,000 strands; what has no room is refused", strand_counts},
    {"scale", "1e-4 to 1e4: the same path within 1e-3 of the length", scale},
    {"grid", "tiny grid, hair outside of it, denormals: no force outside, not slower than twice", grid},
    {"widths", "1, 8 and 16 strands a work-item: all bounds kept", widths},
    {"teleport", "1 km, 91 degrees: moves rigidly, lengths kept", teleport},
    {"spin", "5 to 100 rev/s: bounded, keeps no more energy than drag leaves", spin},
    {"world-offset", "10 km away: the same within 1e-4 of the length", world_offset},
    {"coarse-drags", "fast drags seen at 10 fps: lengths kept, nothing inside", coarse_drags},
    {"overlap", "bodies that overlap, squeeze or hold a node at their centre: pushed out, lengths kept", overlap},
    {"presets", "every preset through shake, turn and teleport", presets},
    {"bad-input", "NaN, infinity and nonsense in a file or --set are refused with their place", bad_input},
    {"injected", "a strand made NaN resets alone in one step, its neighbours keep their bits, its cause is named",
     injected},
    {"pause", "pauses, missed frames, save and reload in mid-motion change nothing", pause_and_reload},
    {"random", "random styles and motions over the whole range of every parameter", random_styles},
    {"soak", "random shakes and wind: finite, lengths kept, no reset, memory and energy constant", soak},
    {"heat", "worst stretch over time step and stiffness, as a map", heat_map},
};

std::span<const Case> cases() { return kCases; }

} // namespace coif::stress
