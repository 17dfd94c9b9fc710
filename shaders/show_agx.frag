#version 150
#define DISPLAY DISPLAY_AGX
#include "show.glsl"
