#pragma once
#include "shape.h"

// Signed distance to the mannequin.
double head(Vec p);

// How far p lies inside the hairline, in metres measured up and down; negative outside.
double inside_hairline(Vec p);
