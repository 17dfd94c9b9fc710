// From light to what a screen shows. Read by GLSL (shaders/show.glsl) and by C++ (app/display.cpp), so that a picture
// made by either is the same. Light is linear, of the sRGB primaries.
#ifndef COIF_DISPLAY_H
#define COIF_DISPLAY_H

// As look.display lists them; which one auto is, the host decides.
#define DISPLAY_NEUTRAL 1
#define DISPLAY_AGX 2
#define DISPLAY_NONE 3

// What is no number is black, what is infinite merely bright.
DISPLAY_FUNCTION vec3 finite_light(vec3 light)
{
    return mix(vec3(0.0f), min(light, vec3(1e6f)), greaterThan(light, vec3(0.0f)));
}

// Khronos PBR Neutral (Khronos Group. PBR Neutral Tone Mapper, version 1.0. 2024). Takes away the 4 % that a surface
// mirrors, and presses together what is left above 0.76, paler the brighter it is.
DISPLAY_FUNCTION vec3 neutral(vec3 light)
{
    const float mirrored = 0.04f, start = 0.8f - mirrored, desaturation = 0.15f, room = 1.0f - start;
    float least = min(light.x, min(light.y, light.z));
    vec3 base = light - vec3(least < 2.0f * mirrored ? least - least * least / (4.0f * mirrored) : mirrored);
    float peak = max(base.x, max(base.y, base.z));
    if (peak < start)
        return base;
    float pressed = 1.0f - room * room / (peak + room - start);
    float colored = 1.0f / (desaturation * (peak - pressed) + 1.0f);
    return mix(vec3(pressed), base * (pressed / peak), colored);
}

// AgX's curve in closed form, of the logarithm's place between its ends (Sobotka. AgX. 2022).
DISPLAY_FUNCTION float agx_curve(float place)
{
    float from_grey = place - 20.0f / 33.0f, far = abs(from_grey);
    float bend = from_grey < 0.0f ? pow(1.0f + 59.507875f * far * far * far, -1.0f / 3.0f)
                                  : pow(1.0f + 69.862789f * pow(far, 3.25f), -4.0f / 13.0f);
    return 0.5f + 2.0f * from_grey * bend;
}

// AgX (Sobotka. 2022; matrices and ends as in Wrensch. Minimal AgX implementation. 2023): each channel takes something
// of the others, so that what is bright grows pale, and gives it back afterwards. Encoded for the screen, not linear.
DISPLAY_FUNCTION vec3 agx(vec3 light)
{
    const float darkest = -12.473931f, brightest = 4.026069f; // EV
    vec3 inset = vec3(0.842479062f, 0.042328242f, 0.042375655f) * light.x +
                 vec3(0.0784336f, 0.878468636f, 0.0784336f) * light.y +
                 vec3(0.079223745f, 0.079166127f, 0.879142974f) * light.z;
    vec3 place = (log2(max(inset, vec3(1e-10f))) - darkest) / (brightest - darkest);
    place = clamp(place, vec3(0.0f), vec3(1.0f));
    vec3 curved = vec3(agx_curve(place.x), agx_curve(place.y), agx_curve(place.z));
    return vec3(1.196879005f, -0.052896852f, -0.052971636f) * curved.x +
           vec3(-0.098020881f, 1.151903130f, -0.098043450f) * curved.y +
           vec3(-0.099029744f, -0.098961177f, 1.151073673f) * curved.z;
}

// IEC 61966-2-1: 1.055 c^(1/2.4) - 0.055 by square roots, which are far cheaper than a power on a processor; within a
// quarter of a byte.
DISPLAY_FUNCTION vec3 srgb_of(vec3 c)
{
    vec3 root2 = sqrt(c), root4 = sqrt(root2), root8 = sqrt(root4);
    vec3 high = 0.662002687f * root2 + 0.684122060f * root4 - 0.323583601f * root8 - 0.0225411470f * c;
    vec3 low = 12.92f * c;
    return mix(high, low, lessThanEqual(c, vec3(0.0031308f)));
}

// What to show for light, 0 to 1 in sRGB: `gain` is the exposure as a factor.
DISPLAY_FUNCTION vec3 shown(vec3 light, float gain, int choice)
{
    vec3 exposed = finite_light(light * gain);
    if (choice == DISPLAY_AGX)
        return clamp(agx(exposed), vec3(0.0f), vec3(1.0f));
    vec3 pressed = choice == DISPLAY_NEUTRAL ? neutral(exposed) : exposed;
    return srgb_of(clamp(pressed, vec3(0.0f), vec3(1.0f)));
}

#endif
