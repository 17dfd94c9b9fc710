// The braid that a strand is plaited into, if any: laid on when it is drawn, about the line that its nodes follow
// (kernels/tails.h).
uniform samplerBuffer braids; // three values a strand: app/renderer_rings.cpp
uniform int braided;          // strands that may be; they come first

struct Braid
{
    vec4 place;              // in its plait
    float behind, per_along; // m behind the ring: at the root, where it is negative, and from root to tip
    float pitch, swing, depth, plait, bound; // as braid_offset() takes them; pitch 0: no braid
} braid;

void find_braid(int strand)
{
    braid.pitch = 0.0;
    if (strand >= braided)
        return;
    vec4 a = texelFetch(braids, 3 * strand), b = texelFetch(braids, 3 * strand + 1),
         c = texelFetch(braids, 3 * strand + 2);
    braid.place = vec4(a.xyz, 0.0);
    braid.behind = a.w;
    braid.per_along = b.x;
    braid.pitch = b.y;
    braid.swing = b.z;
    braid.depth = b.w;
    braid.plait = c.x;
    braid.bound = c.y;
}

// Moves along the strand's normal, binormal and tangent; w: the share of light that comes there, less between plaits,
// which the light's grid is too coarse to tell apart.
vec4 braid_at(float along)
{
    float behind = braid.behind + along * braid.per_along, share = braid_share(behind, braid.pitch);
    vec3 by = braid_offset(behind, braid.place, braid.pitch, braid.swing, braid.depth, braid.plait, braid.bound).xyz;
    vec2 out_of_middle = by.xy / vec2(braid.swing + braid.plait, braid.depth + BRAID_FLAT * braid.plait);
    float open = 0.35 + 0.65 * smoothstep(0.25, 0.95, length(out_of_middle));
    return vec4(share * by, mix(1.0, open, share));
}
