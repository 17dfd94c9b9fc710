// What every draw of one picture shares; mirrored by FrameBlock in app/renderer.cpp. Positions are relative to the head's
// origin, m.
layout(std140) uniform Frame {
    mat4 view_projection;
    vec4 camera_position; // w: metres that a pixel covers at a distance of one metre
    vec4 head_row0;       // head to world
    vec4 head_row1;
    vec4 head_row2;
    vec4 grid_corner;     // w: side of a voxel, m
    vec4 sweep;           // of the light through the grid: kernels/light_grid.h
    ivec4 slices;         // axis, first slice, sign, resolution; resolution 0: no shadow
} frame;
