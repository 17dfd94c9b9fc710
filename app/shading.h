#pragma once
#include "app/rasteriser.h"
#include "kernels/look.h"
#include "sim/lights.h"

#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace coif
{

// What there is to be lit. Positions are relative to the head's origin, m.
struct LitScene
{
    const Solver* solver = nullptr; // draws the strands that it has drawn last
    HairParams params;              // as the device reads them
    std::vector<float> waves;       // wave_table() of sim/wave.h
    std::vector<float4> braids;     // braid_values() of sim/tied_hair.h
    Lighting lighting;
    glm::vec3 low{0.0f}, high{0.0f};    // of what else casts shadows; low above high: nothing
    std::vector<LookSurface> skin = {}; // that sends light back into the hair; its gloss does not
};

// Light between the fibres, for the levels above Kajiya-Kay: one volume of fibre, one sweep through it for each sun,
// the sky, and the colours of the strands and of solid things in them (kernels/look.h). Equal input gives equal bytes
// on a device.
class Shading
{
  public:
    explicit Shading(const Device& device);

    // Follows the light of a scene. Throws Error where the device refuses.
    void light(const LitScene& scene);
    // Colours of the strands as seen from `eye`, at a level above LOOK_KAJIYA_KAY. `kept`: share of them that is drawn;
    // `pieces`, as Rasteriser::measure() has them: what is seen, if only that need be right; `near`: of the light
    // straight from suns, the share that is left to whoever draws them, at levels above LOOK_KARIS.
    const ShadedStrands& shade(glm::vec3 eye, int level, float kept, const cl::Buffer* pieces = nullptr,
                               float near = 0.0f);
    // What the light that shade() has left sends to the eye from NEAR_CELLS cells across each place, as
    // kernels/raster.h has it, for whatever draws other points than the rasteriser's. After shade(), and before lit().
    const cl::Buffer& across();
    // Colours of points of solid things, linear, as many as there are points.
    std::vector<float4> lit(const std::vector<LookSurface>& surfaces, glm::vec3 eye);

    // Share of the suns' light on the strands that comes by way of other fibres, which only LOOK_DUAL_SCATTERING has.
    double handed_on_share();

    const Device& device() const { return passes_.device; }
    const Buffers& buffers() const { return passes_.buffers; } // for tests: by kernel argument
    const LookVolume& volume() const { return volume_; }
    PassTimes take_times() { return passes_.take_times(); }

    // Places times suns up to which light is left, in two bytes each; tests make it small.
    size_t most_lit_places = size_t(1) << 27;

  private:
    void place_volume(const LitScene& scene);
    void sweep(const Lighting& lighting);
    void send_back(const std::vector<LookSurface>& skin);
    void follow(const LookVolume& volume, const std::string& whose, size_t rays, const std::string& what);
    void find_front(glm::vec3 eye);
    void light_surfaces(const std::vector<LookSurface>& surfaces, glm::vec3 eye);
    void look_at(glm::vec3 eye, float kept, size_t surfaces, int stride = 1, float near = 0.0f);

    Passes passes_;
    ShadedStrands shaded_;
    LookVolume volume_ = {}, coarse_ = {};
    HairParams params_ = {};
    glm::vec3 sky_{0.0f};
    int suns_ = 0, braided_ = 0;
    bool skin_ = false;            // sends light back
    std::string options_;          // of the passes that read strands
    std::vector<float> table_key_; // roughness, azimuthal roughness and index that the table of shares is of
    std::vector<float> table_;
};

// Places on a segment that a style's strands are shaded at: enough for what is laid on them.
int shaded_pieces(const HairParams& device_params, const Groom& groom);

// The ray of a volume towards a direction of unit length.
LookRay ray_towards(const LookVolume& volume, glm::vec3 direction);

} // namespace coif
