// The grid's passes take CHUNK voxels side by side along x: a vector on CPUs, one on GPUs and where the resolution does
// not divide.
#ifndef COIF_CHUNK_H
#define COIF_CHUNK_H
#include "shared.h"

#if CHUNK == 16
typedef int16 chunk;
typedef uint16 chunk_bits;
typedef float16 chunk_real;
#define CHUNK_LOAD(p) vload16(0, p)
#define CHUNK_STORE(v, p) vstore16(v, 0, p)
#define CHUNK_STORE_REAL(v, p) vstore16(v, 0, p)
#define CHUNK_TO_REAL(v) convert_float16(v)
#define CHUNK_LANES ((chunk)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define CHUNK_ROUND(v) convert_int16((v) + 0.5f)
#define CHUNK_UP(first, v) ((chunk)(first, v.s01234567, v.s89ab, v.scd, v.se))
#define CHUNK_DOWN(v, last) ((chunk)(v.s1, v.s23, v.s4567, v.s89abcdef, last))
#elif CHUNK == 8
typedef int8 chunk;
typedef uint8 chunk_bits;
typedef float8 chunk_real;
#define CHUNK_LOAD(p) vload8(0, p)
#define CHUNK_STORE(v, p) vstore8(v, 0, p)
#define CHUNK_STORE_REAL(v, p) vstore8(v, 0, p)
#define CHUNK_TO_REAL(v) convert_float8(v)
#define CHUNK_LANES ((chunk)(0, 1, 2, 3, 4, 5, 6, 7))
#define CHUNK_ROUND(v) convert_int8((v) + 0.5f)
#define CHUNK_UP(first, v) ((chunk)(first, v.s0123, v.s45, v.s6))
#define CHUNK_DOWN(v, last) ((chunk)(v.s1, v.s23, v.s4567, last))
#else
typedef int chunk;
typedef uint chunk_bits;
typedef float chunk_real;
#define CHUNK_LOAD(p) (*(p))
#define CHUNK_STORE(v, p) (*(p) = (v))
#define CHUNK_STORE_REAL(v, p) (*(p) = (v))
#define CHUNK_TO_REAL(v) convert_float(v)
#define CHUNK_LANES 0
#define CHUNK_ROUND(v) convert_int((v) + 0.5f)
#define CHUNK_UP(first, v) (first)
#define CHUNK_DOWN(v, last) (last)
#endif
// CHUNK_ROUND is for what is not negative. CHUNK_UP and CHUNK_DOWN move the lanes by one, `first` or `last` coming in;
// through memory that takes far longer.

// Is a chunk outside of the part of the grid that is to be seen to (grid_room.cl)?
static inline int out_of_room(constant int* room, int x, int y, int z)
{
    return z < room[2] || z >= room[5] || y < room[1] || y >= room[4] || x + CHUNK <= room[0] || x >= room[3];
}

#endif
