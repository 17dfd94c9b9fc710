// Files of hair of other tools: the samples with every value right, whatever else with a word and no crash.
#include "sim/exchange/read.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstring>
#include <numbers>

namespace coif
{
namespace
{

using test::bytes_of;
using test::error_of;

fs::path sample(const char* name) { return fs::path(COIF_SOURCE_FOLDER) / "tests" / "exchange" / name; }

const char* const kSamples[] = {"groom.hair", "groom.usda",      "groom_linear.usda", "groom_cache.usda", "groom.tfx",
                                "groom.data", "groom_unity.abc", "groom_unreal.abc",  "groom_cache.abc"};

// What the samples hold: nine strands of 5 to 9 nodes on a ball of 9 cm.
Curves nine_strands()
{
    Curves c;
    for (int i = 0; i < 9; ++i)
    {
        const double t = 2.0 * std::numbers::pi * i / 9.0;
        const int n = 5 + i % 5;
        const double nx = 0.5 * std::cos(t), ny = std::sqrt(0.75), nz = 0.5 * std::sin(t);
        for (int j = 0; j < n; ++j)
        {
            const double s = j / (n - 1.0), r = 0.09 + 0.2 * s * (1.0 - 0.5 * s);
            c.position.emplace_back(nx * r, ny * r - 0.12 * s * s, nz * r + 0.004 * std::sin(9.0 * s + i));
            c.width.push_back(float(8e-5 * (1.0 - 0.7 * s)));
            c.color.emplace_back(0.20 + 0.02 * i, 0.10, 0.05);
        }
        c.count.push_back(uint32_t(n));
        c.root_uv.emplace_back(0.5 + 0.4 * std::cos(t), 0.5 + 0.4 * std::sin(t));
        c.id.push_back(i);
        c.guide.push_back(i % 3 == 0);
    }
    return c;
}

template <typename T> float farthest(const std::vector<T>& a, const std::vector<T>& b)
{
    if (a.size() != b.size())
        return INFINITY;
    float most = 0.0f;
    for (size_t i = 0; i < a.size(); ++i)
        if constexpr (std::is_same_v<T, float>)
            most = std::max(most, std::abs(a[i] - b[i]));
        else
            most = std::max(most, glm::distance(a[i], b[i]));
    return most;
}

std::vector<glm::vec3> scaled(std::vector<glm::vec3> points, float by)
{
    for (glm::vec3& p : points)
        p *= by;
    return points;
}

TEST(ReadHair, every_value_of_the_samples_is_right)
{
    const Curves wanted = nine_strands();
    for (const char* name : kSamples)
    {
        SCOPED_TRACE(name);
        const HairFile file = read_hair_file(sample(name));
        const Curves& c = file.curves;
        const bool abc = std::string(name).ends_with(".abc"), tfx = std::string(name).ends_with(".tfx");
        const float unit = abc ? 0.01f : 1.0f;
        ASSERT_EQ(c.strands(), 9u);
        if (tfx) // resampled to 16 points each
        {
            ASSERT_EQ(c.points(), 144u);
            for (size_t s = 0, first = 0; s < 9; first += wanted.count[s++])
            {
                EXPECT_LT(glm::distance(c.position[16 * s], wanted.position[first]), 1e-7f);
                EXPECT_LT(glm::distance(c.position[16 * s + 15], wanted.position[first + wanted.count[s] - 1]), 1e-6f);
            }
        }
        else
        {
            EXPECT_EQ(c.count, wanted.count);
            std::vector<glm::vec3> position = scaled(c.position, unit);
            if (std::string(name) == "groom_unreal.abc")
                for (glm::vec3& p : position)
                    std::swap(p.y, p.z);
            EXPECT_LT(farthest(position, wanted.position), 3e-8f);
        }
        const bool data = std::string(name).ends_with(".data"), hair = std::string(name).ends_with(".hair");
        std::vector<float> width = c.width;
        for (float& w : width)
            w *= unit;
        if (tfx || data)
            EXPECT_TRUE(c.width.empty() && c.color.empty());
        else
        {
            EXPECT_LT(farthest(width, wanted.width), 1e-11f);
            EXPECT_LT(farthest(c.color, wanted.color), 1e-7f);
        }
        if (hair || data)
            EXPECT_TRUE(c.root_uv.empty());
        else
            EXPECT_LT(farthest(c.root_uv, wanted.root_uv), 1e-7f);
        const bool usd = std::string(name).ends_with(".usda");
        const bool told = usd || abc;
        EXPECT_EQ(c.id, told ? wanted.id : std::vector<int32_t>{});
        EXPECT_EQ(c.guide, usd ? wanted.guide : std::vector<uint8_t>(abc ? 9 : 0, 0));
        EXPECT_EQ(file.unit, usd || hair ? 1.0f : 0.0f);
        EXPECT_EQ(file.up, usd || hair ? HAIR_UP_Y : HAIR_UP_AUTO);
        EXPECT_TRUE(file.remark.empty());
        EXPECT_EQ(c.group_name, told ? std::vector<std::string>{abc ? "hair" : "strands"} : std::vector<std::string>{});
    }
}

// Reads, and says what was wrong; whatever else is thrown fails the test.
std::string told(const std::string& bytes, const char* suffix)
{
    return error_of([&] { parse_hair_file(bytes, "x", suffix); });
}

TEST(ReadHair, cut_anywhere_it_is_an_error_and_never_a_crash)
{
    const test::TimeLimit limit(100);
    for (const char* name : kSamples)
    {
        SCOPED_TRACE(name);
        const std::string whole = bytes_of(sample(name)), suffix = sample(name).extension().string();
        EXPECT_EQ(told(whole, suffix.c_str()), "no error");
        size_t read = 0;
        for (size_t size = 0; size < whole.size(); size += 1 + whole.size() / 6000)
        {
            // A copy of just that size, so that the sanitizers see a step beyond it.
            const std::string cut(whole.data(), size);
            read += told(cut, suffix.c_str()) == "no error";
        }
        // Only what a file ends with may be missing: its last line's end, or bytes that say nothing.
        EXPECT_LT(read, 60u);
    }
}

TEST(ReadHair, with_bytes_changed_it_is_an_error_or_hair_and_never_a_crash)
{
    const test::TimeLimit limit(200);
    std::mt19937 random(7);
    for (const char* name : kSamples)
    {
        const std::string whole = bytes_of(sample(name)), suffix = sample(name).extension().string();
        for (int i = 0; i < 2000; ++i)
        {
            std::string bytes = whole;
            for (unsigned changes = 1 + random() % 4; changes > 0; --changes)
            {
                const size_t at = random() % bytes.size();
                bytes[at] = i % 3 == 0 ? '\xff' : i % 3 == 1 ? char(random()) : char(bytes[at] + 1);
            }
            HairFile file;
            if (error_of([&] { file = parse_hair_file(bytes, "x", suffix); }) != "no error")
                continue;
            const Curves& c = file.curves;
            size_t points = 0;
            for (const uint32_t count : c.count)
            {
                ASSERT_GE(count, 2u);
                points += count;
            }
            ASSERT_EQ(points, c.points());
            for (const glm::vec3& p : c.position)
                ASSERT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1e6f);
            ASSERT_TRUE(c.width.empty() || c.width.size() == points);
            ASSERT_TRUE(c.color.empty() || c.color.size() == points);
            ASSERT_TRUE(c.root_uv.empty() || c.root_uv.size() == c.strands());
            ASSERT_TRUE(c.guide.empty() || c.guide.size() == c.strands());
        }
    }
}

TEST(ReadHair, what_cannot_be_read_says_what_to_do)
{
    EXPECT_NE(told("\x89HDF\r\n\x1a\n and more", ".abc").find("export it again as Ogawa"), std::string::npos);
    EXPECT_NE(told("PXR-USDC and more", ".usd").find("usdcat x -o new.usda"), std::string::npos);
    EXPECT_NE(told("PK\3\4 and more", ".usdz").find("unpack it"), std::string::npos);
    EXPECT_NE(told("solid cube", ".stl").find("Alembic (.abc), .hair, USD text"), std::string::npos);
    EXPECT_NE(told("", ".hair").find("is no file of hair"), std::string::npos);
    EXPECT_NE(told("#usda 1.0\ndef Xform \"a\"\n{\n}\n", ".usda").find("holds no strands of hair"), std::string::npos);
    EXPECT_NE(told("#usda 1.0\ndef BasisCurves \"a\" { int[] curveVertexCounts = [] point3f[] points = [] }", ".usda")
                  .find("holds no strands of hair"),
              std::string::npos);
    EXPECT_EQ(told("#usda 1.0\ndef Xform \"a\"\n{\n", ".usda"),
              "x:4: the prim 'a' has no end: the file was not copied whole");
    EXPECT_EQ(told("#usda 1.0\ndef Xform \"a\"\n{\n    float3[] points = [(1, 2\n", ".usda"),
              "x:5: a bracket has no end: the file was not copied whole");
    std::string deep = "#usda 1.0\n";
    for (int i = 0; i < 100; ++i)
        deep += "def Xform \"a\" {\n";
    EXPECT_NE(told(deep, ".usda").find("more than 64 deep"), std::string::npos);
    std::string version(200, '\0');
    EXPECT_NE(told(version, ".tfx").find("export it again for TressFX 4 or 5"), std::string::npos);
}

// Counts that promise more than any memory: refused by the file's size, before anything is taken.
TEST(ReadHair, counts_are_bounded_by_the_file)
{
    std::string hair = bytes_of(sample("groom.hair"));
    for (size_t at : {4, 8, 16})
        for (uint32_t count : {0xffffffffu, 0x80000000u, 0x7fffffffu, 1000000u})
        {
            std::string bytes = hair;
            memcpy(bytes.data() + at, &count, 4);
            EXPECT_EQ(told(bytes, ".hair") == "no error", at == 16); // which this file does not use
            bytes[12] = char(bytes[12] & ~1);                        // without segments of its own
            EXPECT_NE(told(bytes, ".hair"), "no error");
        }
    for (size_t at : {4, 8, 12, 16})
        for (uint32_t count : {0xffffffffu, 0x80000000u, 0xfffffff0u})
        {
            std::string bytes = bytes_of(sample("groom.tfx"));
            memcpy(bytes.data() + at, &count, 4);
            EXPECT_NE(told(bytes, ".tfx"), "no error") << at;
        }
    for (int32_t count : {-1, 0x7fffffff, 1000000})
    {
        std::string bytes = bytes_of(sample("groom.data"));
        memcpy(bytes.data(), &count, 4);
        EXPECT_NE(told(bytes, ".data"), "no error");
        bytes = bytes_of(sample("groom.data"));
        memcpy(bytes.data() + 4, &count, 4);
        EXPECT_NE(told(bytes, ".data"), "no error");
    }
}

// Groups that hold themselves: 64 deep, each twice, would be visited 2^64 times.
TEST(ReadHair, an_archive_that_holds_itself_ends)
{
    const test::TimeLimit limit(20);
    const std::string whole = bytes_of(sample("groom_unity.abc"));
    std::mt19937 random(3);
    std::vector<uint64_t> offsets;
    for (size_t at = 16; at + 8 <= whole.size(); ++at)
    {
        uint64_t value;
        memcpy(&value, whole.data() + at, 8);
        if (value > 16 && value < whole.size())
            offsets.push_back(at);
    }
    for (int i = 0; i < 20000; ++i)
    {
        std::string bytes = whole;
        for (int k = 0; k < 3; ++k)
            memcpy(bytes.data() + offsets[random() % offsets.size()], whole.data() + offsets[random() % offsets.size()],
                   8);
        told(bytes, ".abc");
    }
}

TEST(ReadHair, strands_that_are_none_are_dropped_with_a_word)
{
    HairFile file;
    file.curves.count = {2, 1, 3, 2, 2};
    file.curves.position = {{0, 0, 0}, {0, 1, 0}, {5, 5, 5}, {0, 0, 0}, {NAN, 0, 0},
                            {0, 0, 2}, {1, 1, 1}, {1, 1, 1}, {3, 0, 0}, {4, 0, 0}};
    file.curves.width = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    file.curves.id = {10, 11, 12, 13, 14};
    file.curves.color.assign(10, {0.0f, INFINITY, 0.0f});
    drop_bad_strands(file);
    EXPECT_EQ(file.curves.count, (std::vector<uint32_t>{2, 2}));
    EXPECT_EQ(file.curves.position.back(), glm::vec3(4, 0, 0));
    EXPECT_EQ(file.curves.width, (std::vector<float>{1, 2, 9, 10}));
    EXPECT_EQ(file.curves.id, (std::vector<int32_t>{10, 14}));
    EXPECT_TRUE(file.curves.color.empty());
    EXPECT_EQ(file.remark,
              (std::vector<std::string>{
                  "its colours are not all numbers, and are not read",
                  "1 of its strands have less than two points, and are dropped",
                  "1 of its strands have points that are no numbers, or lie beyond a million, and are dropped",
                  "1 of its strands have no length, and are dropped"}));
}

const char* const kNested = R"(#usda 1.0
(
    "a comment with ( and ] in it"
    metersPerUnit = 0.01
    upAxis = 'Z'
    customLayerData = { string tool = "x}" }
)

def Xform "character" ( kind = "component" )
{
    double3 xformOp:translate = (0, 0, 10)
    float xformOp:rotateZ:spin = 90  # about z
    float3 xformOp:scale = (2, 2, 2)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ:spin", "xformOp:scale"]
    class "none" { def BasisCurves "c" { int[] curveVertexCounts = [2]  point3f[] points = [(0,0,0),(1,1,1)] } }
    over "unsaid"
    {
        rel material:binding = </x>
        matrix4d xformOp:transform = ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (1, 0, 0, 1) )
        uniform token[] xformOpOrder = ["xformOp:transform"]
        def BasisCurves "long"
        {
            uniform token type = "cubic"
            uniform token basis = "bspline"
            uniform token wrap = "nonperiodic"
            int[] curveVertexCounts = [4, 5]
            point3f[] points.timeSamples = {
                0: [(0,0,0), (6,0,0), (12,0,0), (18,0,0), (0,0,0), (0,6,0), (0,12,0), (0,18,0), (0,24,0)],
                1: [(9,9,9)],
            }
            float[] widths = [1, 2] ( interpolation = "uniform" )
            color3f[] primvars:displayColor = [(0, 1, 0), (1, 0, 0)] (
                interpolation = "uniform"
            )
            int[] primvars:displayColor:indices = [1, 0]
            texCoord2f[] primvars:st = None
            float3[] velocities
            custom double other:thing.timeSamples = { 0: 1, }
        }
        def BasisCurves "off" ( active = false ) { int[] curveVertexCounts = [2]  point3f[] points = [(0,0,0),(1,1,1)] }
    }
}
)";

TEST(ReadHair, usd_in_the_words_of_others)
{
    const HairFile file = parse_hair_file(kNested, "x", ".usd");
    EXPECT_EQ(file.unit, 0.01f);
    EXPECT_EQ(file.up, HAIR_UP_Z);
    const Curves& c = file.curves;
    ASSERT_EQ(c.count, (std::vector<uint32_t>{2, 3})) << "the first and the last only lead in and out";
    // By 1 along x, then twice as large, turned from x to y and lifted.
    const glm::vec3 wanted[] = {{0, 14, 10}, {0, 26, 10}, {-12, 2, 10}, {-24, 2, 10}, {-36, 2, 10}};
    for (size_t i = 0; i < 5; ++i)
        EXPECT_LT(glm::distance(c.position[i], wanted[i]), 1e-5f) << i;
    EXPECT_EQ(c.width, (std::vector<float>{2, 2, 4, 4, 4}));
    EXPECT_EQ(c.color[0], glm::vec3(1, 0, 0));
    EXPECT_EQ(c.color[4], glm::vec3(0, 1, 0));
    EXPECT_TRUE(c.root_uv.empty());
}

// Moved by 10 along z and twice as large; in it one more turned from x to y, moved by 5 and turned again, of which the
// curves are; and one that does not inherit that, half a turn about y.
TEST(ReadHair, alembic_under_transforms_with_indexed_values)
{
    const HairFile file = read_hair_file(sample("nested.abc"));
    const Curves& c = file.curves;
    ASSERT_EQ(c.count, (std::vector<uint32_t>{3, 2, 4}));
    // A row of (x, y): by the matrix (5 - y, x), then turned (-x, 5 - y), doubled.
    const glm::vec3 wanted[] = {{0, 10, 10}, {-2, 10, 10}, {-4, 10, 10}, {0, 8, 10}, {0, 6, 10},
                                {0, 0, 0},   {-5, 1, 0},   {-6, 5, -1},  {-6, 6, -6}}; // the last a B-spline
    for (size_t i = 0; i < 9; ++i)
        EXPECT_LT(glm::distance(c.position[i], wanted[i]), 2e-6f)
            << i << ": " << c.position[i].x << " " << c.position[i].y << " " << c.position[i].z;
    const std::vector<float> width = {0.5f, 0.5f, 0.5f, 1.0f, 1.0f, 0.1f, 0.1f, 0.1f, 0.1f};
    EXPECT_LT(farthest(c.width, width), 1e-6f) << "as large as the transforms make them";
    EXPECT_EQ(c.root_uv, (std::vector<glm::vec2>{{0.5f, 0.75f}, {0.0f, 0.0f}, {0.1f, 0.2f}}));
    EXPECT_EQ(c.guide, (std::vector<uint8_t>{1, 1, 0}));
    EXPECT_EQ(c.group, (std::vector<int32_t>{0, 0, 1}));
    EXPECT_EQ(c.group_name, (std::vector<std::string>{"fringe", "strand"}));
    EXPECT_EQ(file.remark, std::vector<std::string>{"its 1 PolyMesh objects are no hair, and are not read"});
}

} // namespace
} // namespace coif
