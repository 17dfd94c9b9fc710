#version 150
#define DISPLAY DISPLAY_NONE
#include "show.glsl"
