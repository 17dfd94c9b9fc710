// The thesis' own way, kept to be measured against: the mean of 27 voxels (section 5.1.3). One work-item a voxel, by
// three indices; beyond the grid there is no hair.
kernel void blur_density(global const int* density, global int* blurred)
{
    const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
    int sum = 0;
    for (int k = z - 1; k <= z + 1; ++k)
        for (int j = y - 1; j <= y + 1; ++j)
            for (int i = x - 1; i <= x + 1; ++i)
                if (i >= 0 && j >= 0 && k >= 0 && i < RESOLUTION && j < RESOLUTION && k < RESOLUTION)
                    sum += density[i + j * RESOLUTION + k * RESOLUTION * RESOLUTION];
    blurred[x + y * RESOLUTION + z * RESOLUTION * RESOLUTION] = sum / 27;
}
