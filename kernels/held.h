// How many nodes of a strand are prescribed, from the root on: two, or with HELD as many as reach through a tie, which
// differs from lane to lane. Without HELD all of this is known when the kernel is built and costs nothing.
#ifndef COIF_HELD_H
#define COIF_HELD_H
#include "drawn_lanes.h"

#ifdef HELD
typedef whole held_count;
typedef real lane_share;
#define HELD_SHARE(test, yes, no) select((real)(no), (real)(yes), test)
#define UNLESS_HELD(node, held, was, is) select(is, was, (node) < (held))
#define POINTS_UNLESS_HELD(node, held, was, is) select_points(is, was, (node) < (held))
#define HELD_SEGMENTS(node, held) TO_REAL((node) + 2 - (held)) // from the last held node but one
#else
typedef int held_count;
typedef float lane_share;
#define HELD_SHARE(test, yes, no) ((test) ? (yes) : (no))
#define UNLESS_HELD(node, held, was, is) (is)
#define POINTS_UNLESS_HELD(node, held, was, is) (is)
#define HELD_SEGMENTS(node, held) ((float)(node))
#endif

#endif
