// Kajiya-Kay: a fibre scatters light as a thin cylinder does, so only angles to its tangent count (Kajiya, Kay. Rendering
// fur with three dimensional textures. 1989; thesis eq. 5.9 and 5.10, with the exponents of listing A.2).
//
// tangent, to_camera: of unit length. hair: linear colour. light: share of the light that reaches the place.
vec3 kajiya_kay(vec3 tangent, vec3 to_camera, vec3 hair, float light)
{
    float tl = clamp(dot(tangent, params.look_light_direction.xyz), -1.0, 1.0);
    float te = clamp(dot(tangent, to_camera), -1.0, 1.0);
    float sin_tl = sqrt(1.0 - tl * tl), sin_te = sqrt(1.0 - te * te);
    float diffuse = params.look_diffuse * pow(sin_tl, params.look_diffuse_exponent);
    // Listing A.2 measures the eye's angle from the other end of the tangent: the cone of reflection has its mirror there.
    float specular = params.look_specular * pow(max(0.0, sin_tl * sin_te - tl * te), params.look_specular_exponent);
    // Hair that hides from the light hides from the surroundings too, though far less: they come in from all sides.
    float ambient = params.look_ambient * mix(0.4, 1.0, pow(light, 0.35));
    vec3 lit = light * params.look_light_color.rgb;
    // The highlight leaves the surface almost uncoloured.
    return hair * (ambient + diffuse * lit) + mix(vec3(1.0), hair, 0.4) * specular * lit;
}
