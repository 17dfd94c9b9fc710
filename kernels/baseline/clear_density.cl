// The thesis' own way, kept to be measured against: listing 5.2. One work-item a voxel, by three indices.
kernel void clear_density(global int* density)
{
    density[get_global_id(0) + get_global_id(1) * RESOLUTION + get_global_id(2) * RESOLUTION * RESOLUTION] = 0;
}
