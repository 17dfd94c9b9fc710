// The thesis' own way, kept to be measured against: central differences (listing 5.3). One work-item a voxel, by three
// indices; beyond the grid there is no hair.
static int density_at(global const int* density, int x, int y, int z)
{
    const int within = x >= 0 && y >= 0 && z >= 0 && x < RESOLUTION && y < RESOLUTION && z < RESOLUTION;
    return within ? density[x + y * RESOLUTION + z * RESOLUTION * RESOLUTION] : 0;
}

kernel void density_gradient(global const int* blurred, global float4* gradient)
{
    const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
    gradient[x + y * RESOLUTION + z * RESOLUTION * RESOLUTION] =
        0.5f * (float4)(density_at(blurred, x + 1, y, z) - density_at(blurred, x - 1, y, z),
                        density_at(blurred, x, y + 1, z) - density_at(blurred, x, y - 1, z),
                        density_at(blurred, x, y, z + 1) - density_at(blurred, x, y, z - 1), 0.0f);
}
