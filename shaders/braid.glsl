// The braid that a strand is plaited into, if any, out of a texture.
uniform samplerBuffer braids; // three values a strand: app/renderer_rings.cpp
uniform int braided;          // strands that may be; they come first

Braid braid; // of this strand

void find_braid(int strand)
{
    braid.pitch = 0.0;
    if (strand < braided)
        braid = braid_of(texelFetch(braids, 3 * strand), texelFetch(braids, 3 * strand + 1),
                         texelFetch(braids, 3 * strand + 2));
}
