#include "sim/models/reference.h"

#include "sim/error.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

namespace coif::study
{

// 0 to 1 with two continuous derivatives.
static double ease(double u)
{
    u = std::clamp(u, 0.0, 1.0);
    return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
}

static glm::dvec3 shaken(double t)
{
    return {0.05 * ease(t / 0.25) * std::sin(2.0 * std::numbers::pi * 1.5 * t), 0.0, 0.0};
}

static glm::dvec3 turned(double t)
{
    const double angle = std::numbers::pi / 2.0 * ease(t / 0.30);
    return {0.10 * std::cos(angle), 0.0, -0.10 * std::sin(angle)};
}

static Scene let_go(double degrees, double drag)
{
    const double angle = degrees * std::numbers::pi / 180.0;
    Scene scene;
    scene.drag = drag;
    scene.direction = {std::sin(angle), -std::cos(angle), 0.0};
    return scene;
}

const std::vector<Reference>& references()
{
    static const std::vector<Reference> all = []
    {
        Scene shake, turn;
        shake.drag = 2.0;
        shake.root = shaken;
        turn.drag = 1.0;
        turn.root = turned;
        return std::vector<Reference>{{"shake_b2", shake, 60.0, 3.0},
                                      {"turn_b1", turn, 60.0, 2.0},
                                      {"release30_b0", let_go(30.0, 0.0), 60.0, 3.0},
                                      {"release90_b1", let_go(90.0, 1.0), 60.0, 2.0}};
    }();
    return all;
}

const Reference& reference(const std::string& name)
{
    std::string names;
    for (const Reference& each : references())
    {
        if (each.name == name)
            return each;
        names += (names.empty() ? "" : ", ") + each.name;
    }
    throw fail("there is no reference '{}'; there are: {}", name, names);
}

Frames read_frames(const std::filesystem::path& csv)
{
    std::ifstream file(csv);
    std::string line, cell;
    if (!std::getline(file, line))
        throw fail("{}: cannot be read", csv.string());
    Frames frames;
    while (std::getline(file, line))
    {
        std::istringstream cells(line);
        std::vector<double> numbers;
        while (std::getline(cells, cell, ','))
            numbers.push_back(std::strtod(cell.c_str(), nullptr));
        if (numbers.size() % 3 != 1 || (!frames.empty() && numbers.size() != 3 * frames[0].size() + 1))
            throw fail("{}: line {} is not a time and the places of as many nodes as before", csv.string(),
                       frames.size() + 2);
        frames.emplace_back();
        for (size_t i = 1; i < numbers.size(); i += 3)
            frames.back().emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    }
    return frames;
}

Difference compare(const Frames& frames, const Frames& reference, double length)
{
    double sum = 0.0, worst = 0.0;
    size_t count = 0;
    for (size_t f = 1; f < reference.size(); ++f)
    {
        if (f >= frames.size())
            return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
        assert(frames[f].size() == reference[f].size());
        for (size_t i = 1; i < reference[f].size(); ++i, ++count)
        {
            const double distance = glm::distance(frames[f][i], reference[f][i]);
            sum += distance * distance;
            worst = std::max(worst, distance);
        }
    }
    return {count ? std::sqrt(sum / double(count)) / length : 0.0, worst / length};
}

Scene cantilever(int links, double gamma)
{
    Scene scene;
    scene.links = links;
    scene.length = 0.02 * links;
    scene.drag = 8.0;
    scene.tip_mass = 0.5;
    scene.gamma = gamma;
    scene.direction = {1.0, 0.0, 0.0};
    return scene;
}

double droop(const Frames& frames)
{
    const glm::dvec3 tip = frames.back().back() - frames.back().front();
    return -tip.y / std::hypot(tip.x, tip.z);
}

} // namespace coif::study
