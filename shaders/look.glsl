// What of a strand's look and waves varies over the scalp: its own, or else the style's (StrandLook of
// kernels/shared.h).
uniform sampler2D looks; // four texels a strand, 512 strands a row; 1 x 1 where nothing varies
uniform int varied;

struct Look {
    vec3 root_color, tip_color; // linear
    float width;                // m
    float opacity;
    float normal_amplitude, normal_frequency, binormal_amplitude, binormal_frequency; // m, 1/m
    float curl, frizz; // m
    int seed;
};

Look look_of(int strand)
{
    if (varied == 0)
        return Look(params.look_root_color.rgb, params.look_tip_color.rgb, params.look_width, params.look_opacity,
                    params.wave_normal_amplitude, params.wave_normal_frequency, params.wave_binormal_amplitude,
                    params.wave_binormal_frequency, params.curl_radius, params.frizz_amount,
                    strand + 7919 * params.interpolation_seed);
    ivec2 at = ivec2(4 * (strand % 512), strand / 512);
    vec4 root = texelFetch(looks, at, 0), tip = texelFetch(looks, at + ivec2(1, 0), 0);
    vec4 wave = texelFetch(looks, at + ivec2(2, 0), 0), own = texelFetch(looks, at + ivec2(3, 0), 0);
    return Look(root.rgb, tip.rgb, root.w, tip.w, wave.x, wave.y, wave.z, wave.w, own.y, own.z,
                int(own.x));
}
