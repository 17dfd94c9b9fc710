// Gives kernels/ribbon.h the names that it expects; params and the texture `wave` are in scope.
#define STRUCT(name) struct name
#define WITH_STYLE
#define STYLE(name) params.name
#define POWER(x, y) pow(x, y)
#define WAVE_NORMAL(place) texture(wave, place).r
#define WAVE_BINORMAL(place) texture(wave, place).g
#include "ribbon.h"
