#version 150
#define DISPLAY DISPLAY_NEUTRAL
#include "show.glsl"
