// The cases by what they strain. The table is in cases.cpp; what is expected stands there.
#pragma once
#include "app/stress/stage.h"

namespace coif::stress
{

// cases_time.cpp
Outcome frame_lengths(const Ground& ground);
Outcome free_fall(const Ground& ground);
Outcome pause_and_reload(const Ground& ground);

// cases_forces.cpp
Outcome gravity(const Ground& ground);
Outcome wind(const Ground& ground);
Outcome drag(const Ground& ground);
Outcome iterations(const Ground& ground);
Outcome stiffness(const Ground& ground);

// cases_shape.cpp
Outcome no_length(const Ground& ground);
Outcome node_counts(const Ground& ground);
Outcome strand_counts(const Ground& ground);
Outcome scale(const Ground& ground);
Outcome grid(const Ground& ground);
Outcome widths(const Ground& ground);

// cases_motion.cpp
Outcome teleport(const Ground& ground);
Outcome spin(const Ground& ground);
Outcome world_offset(const Ground& ground);
Outcome coarse_drags(const Ground& ground);
Outcome overlap(const Ground& ground);
Outcome presets(const Ground& ground);

// cases_faults.cpp
Outcome bad_input(const Ground& ground);
Outcome injected(const Ground& ground);

// random.cpp
Outcome random_styles(const Ground& ground);

// soak.cpp
Outcome soak(const Ground& ground);

// heat_map.cpp
Outcome heat_map(const Ground& ground);

} // namespace coif::stress
