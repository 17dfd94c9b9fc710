// The grid's passes take CHUNK voxels side by side along x: a vector on CPUs, one on GPUs and where the resolution does
// not divide.
#ifndef COIF_CHUNK_H
#define COIF_CHUNK_H
#include "shared.h"

#if CHUNK == 16
typedef int16 chunk;
typedef float16 chunk_real;
#define CHUNK_LOAD(p) vload16(0, p)
#define CHUNK_STORE(v, p) vstore16(v, 0, p)
#define CHUNK_STORE_REAL(v, p) vstore16(v, 0, p)
#define CHUNK_TO_REAL(v) convert_float16(v)
#elif CHUNK == 8
typedef int8 chunk;
typedef float8 chunk_real;
#define CHUNK_LOAD(p) vload8(0, p)
#define CHUNK_STORE(v, p) vstore8(v, 0, p)
#define CHUNK_STORE_REAL(v, p) vstore8(v, 0, p)
#define CHUNK_TO_REAL(v) convert_float8(v)
#else
typedef int chunk;
typedef float chunk_real;
#define CHUNK_LOAD(p) (*(p))
#define CHUNK_STORE(v, p) (*(p) = (v))
#define CHUNK_STORE_REAL(v, p) (*(p) = (v))
#define CHUNK_TO_REAL(v) convert_float(v)
#endif
#define CHUNK_LANE(v, lane) (((float*)&(v))[lane])

#endif
