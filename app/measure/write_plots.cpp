// The plots as files: scripts, and the pictures that gnuplot makes of them.
#include "app/gnuplot.h"
#include "app/measure/plots.h"
#include "sim/error.h"
#include "sim/hairstyle.h"

#include <unistd.h>

namespace coif
{

namespace fs = std::filesystem;

static std::string script_of(const Plot& plot)
{
    // Drawn twice, with nothing kept in between but the data.
    return fmt::format(
        "# Made by coif measure. Run `gnuplot {0}.gp` for {0}.svg and {0}.png.\n{1}\n"
        "set terminal svg size {2},{3} dynamic font 'Helvetica,12' background 'white'\n"
        "set output '{0}.svg'\n{4}\nunset output\nreset\n"
        "set terminal pngcairo size {5},{6} font 'Sans,12' fontscale 2 linewidth 2 pointscale 2 background "
        "'white'\nset output '{0}.png'\n{4}\nunset output\n",
        plot.name, plot.data, plot.width, plot.height, plot.body, 2 * plot.width, 2 * plot.height);
}

std::string write_plots(const fs::path& folder, const std::vector<Plot>& plots)
{
    const fs::path shown = folder / "plots", making = shown / fmt::format(".making_{}", getpid());
    make_folder(making);
    std::error_code error;
    std::string trouble;
    for (const Plot& plot : plots)
    {
        write_file(shown / (plot.name + ".gp"), script_of(plot));
        if (!trouble.empty())
            continue;
        const int status = run_gnuplot(making, "../" + plot.name + ".gp", "log");
        if (status < 0)
            trouble =
                fmt::format("gnuplot is not installed, so there are no plots, only their scripts in {}; on Debian "
                            "and Ubuntu: apt install gnuplot",
                            shown.string());
        else if (status > 0)
            trouble = fmt::format("gnuplot could not draw {}: {}", plot.name, read_file(making / "log"));
        else
            for (const char* ending : {".svg", ".png"})
                fs::rename(making / (plot.name + ending), shown / (plot.name + ending), error);
        if (error)
            trouble = fmt::format("{} was not drawn: {}", plot.name, error.message());
    }
    fs::remove_all(making, error);
    return trouble;
}

} // namespace coif
