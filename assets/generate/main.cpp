// Makes the scalps, the head and the head's collision spheres that coif ships: `generate FOLDER`. The same program
// always writes the same bytes.
#include "head.h"
#include "polygonise.h"
#include "scalp.h"
#include "spheres.h"

#include <cstdio>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

namespace
{

std::string number(double value, int decimals)
{
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
    const std::string number = text.data();
    return number.find_first_not_of("-0.") == std::string::npos && number[0] == '-' ? number.substr(1) : number;
}

void write(const std::string& path, const std::string& text)
{
    std::ofstream file(path, std::ios::binary);
    file << text << std::flush;
    if (!file)
        throw std::runtime_error("cannot write " + path);
}

std::string obj(const Mesh& mesh, const std::string& what, int decimals)
{
    std::string text = "# " + what + "; made by assets/generate\n";
    for (const Vec& p : mesh.points)
        text += "v " + number(p.x, decimals) + " " + number(p.y, decimals) + " " + number(p.z, decimals) + "\n";
    for (const auto& t : mesh.triangles)
        text +=
            "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
    return text;
}

std::string toml(const std::vector<Sphere>& spheres)
{
    std::string text = "# The collision spheres of head.obj in metres, made by assets/generate.\n";
    const auto collider = [&](Vec c, double radius)
    {
        text += "\n[[collider]]\ncenter = [" + number(c.x, 4) + ", " + number(c.y, 4) + ", " + number(c.z, 4) +
                "]\nradius = " + number(radius, 4) + "\n";
    };
    for (const Sphere& s : spheres)
    {
        collider(s.centre, s.radius);
        if (s.centre.x != 0)
            collider({-s.centre.x, s.centre.y, s.centre.z}, s.radius);
    }
    return text;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::cerr << "usage: generate FOLDER\n";
        return 2;
    }
    const std::string folder = std::string(argv[1]) + "/";
    const auto top = [](Vec p) { return smooth_min(inside_hairline(p), p.y - 0.053 + 0.15 * p.z, 0.02); };
    const auto strip = [](Vec p) { return smooth_min(inside_hairline(p), 0.0175 - std::abs(p.x), 0.01); };
    // Face and ears are what one looks at, braincase and bust are large.
    const auto sag = [](Vec p)
    {
        const double face = ramp(0.03, 0.06, p.z) * ramp(0.05, 0.02, p.y) * ramp(-0.15, -0.12, p.y);
        const double ears = ramp(0.060, 0.070, std::abs(p.x)) * ramp(0.02, 0.005, p.y) * ramp(-0.08, -0.065, p.y);
        return std::lerp(10e-5, 2.5e-5, std::max(face, 0.8 * ears));
    };
    try
    {
        write(folder + "scalp.obj", obj(scalp(7, head, inside_hairline), "the whole scalp, a guide a vertex", 6));
        write(folder + "scalp_top.obj", obj(scalp(11, head, top), "the top of the scalp, for an undercut", 6));
        write(folder + "scalp_strip.obj", obj(scalp(16, head, strip), "a strip along the midline, for a mohawk", 6));
        // A grid so fine that no cell holds two sheets of an ear, which would be welded.
        const Mesh bust = polygonise(head, {-0.18, -0.30, -0.13}, {0.18, 0.11, 0.14}, 0.0027, sag, 0.0009);
        write(folder + "head.obj", obj(bust, "a mannequin's bust for the scalps beside it", 5));
        write(folder + "head_spheres.toml", toml(fill_with_spheres(bust, head, inside_hairline, 35)));
    }
    catch (const std::runtime_error& error)
    {
        std::cerr << "generate: " << error.what() << "\n";
        return 1;
    }
}
