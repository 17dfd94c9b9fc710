// Sets the density to zero (thesis, listing 5.2). One work-item a voxel.
kernel void clear_density(global int* density) { density[get_global_id(0)] = 0; }
