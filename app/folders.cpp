#include "app/folders.h"

#include <cstdlib>

namespace coif
{

namespace fs = std::filesystem;

static fs::path xdg(const char* variable, const char* otherwise)
{
    // A relative path is none, says the specification.
    if (const char* wish = std::getenv(variable); wish && fs::path(wish).is_absolute())
        return fs::path(wish) / "coif";
    if (const char* home = std::getenv("HOME"); home && fs::path(home).is_absolute())
        return fs::path(home) / otherwise / "coif";
    return {};
}

fs::path state_folder() { return xdg("XDG_STATE_HOME", ".local/state"); }

fs::path recovery_folder() { return state_folder().empty() ? fs::path() : state_folder() / "recovery"; }
fs::path config_folder() { return xdg("XDG_CONFIG_HOME", ".config"); }

} // namespace coif
