#pragma once
#include "app/look_error.h"

#include <atomic>
#include <future>
#include <string>

namespace coif
{

// Holds the level that is shown against light that is followed through the same strands, in a thread of its own.
class LookProbe
{
  public:
    ~LookProbe(); // stops it
    // Takes the picture that is judged, and the strands, at once; `level` is not auto. Throws Error.
    void begin(Renderer& renderer, Simulation& simulation, const Camera& camera, int level);
    bool busy() const { return work_.valid(); }
    // True when it has come to an end. Throws Error where it failed.
    bool look();
    // "dual_scattering has 0.97 1.00 1.01 of the traced light, 9 % off"; empty before there was one. Says so if the
    // look has changed since.
    std::string said(const HairParams& params, const Lighting& lighting) const;

  private:
    struct Of
    {
        HairParams params;
        Lighting lighting;
    };
    std::future<std::string> work_;
    std::atomic<bool> stop_ = false;
    Of of_ = {};
    std::string said_;
};

} // namespace coif
