#pragma once
#include "shape.h"

// Triangles on field = 0 within the box, about `low` to `high`: surface nets on a grid of `step` metres, then remeshed
// so that a triangle's sides sag by `sag` metres (given a place) at most, but are no shorter than `finest`.
Mesh polygonise(const Field& field, Vec low, Vec high, double step, const Field& sag, double finest);

// The mesh without points that no triangle uses; the others keep their order.
Mesh without_loose_points(const Mesh& mesh);
