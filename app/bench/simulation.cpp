// What moving hair takes: a whole head of strands, and few of which many are drawn.
#include "app/bench/hair.h"

namespace coif
{

// Rows of one kind of hair, with what is known of it besides times.
static void add_rows(std::vector<BenchRow>& all, std::vector<BenchRow> rows, BenchHair& hair, const Benching& with,
                     const std::string& note)
{
    const std::map<std::string, double> traffic = traffic_of(hair.solver());
    for (BenchRow& row : rows)
    {
        row.note = note;
        row.strands = hair.strands();
        row.cores = with.machine.compute_units;
        const auto bytes = traffic.find(row.what);
        if (bytes != traffic.end())
            row.bytes = bytes->second;
        all.push_back(row);
    }
}

std::vector<BenchRow> bench_whole_head(const Benching& with)
{
    const std::vector<std::string> all = {"interpolation.guides=all", "interpolation.strands=102400",
                                          "look.self_shadow=0", "forces.repulsion=0", "forces.wind=[0, 0, 0]"};
    const auto also = [&](std::vector<std::string> more)
    {
        more.insert(more.begin(), all.begin(), all.end());
        return more;
    };
    struct HeadCase
    {
        const char* note;
        std::vector<std::string> sets;
        double most_ms;
    };
    const HeadCase kinds[] = {
        {"lengths alone", also({"bending.droop=10000", "head.mesh=", "head.spheres="}), NAN},
        {"bending, head", also({}), 1000.0 / 60.0},
        {"wind and repulsion too", also({"forces.wind=[3, 0, 0]", "forces.repulsion=1"}), 1000.0 / 30.0},
    };
    std::vector<BenchRow> rows;
    std::vector<std::unique_ptr<BenchHair>> hair;
    std::vector<std::function<PassTimes()>> runs;
    for (const HeadCase& kind : kinds)
    {
        with.progress(kind.note);
        hair.push_back(std::make_unique<BenchHair>(with.device, "bob", kind.sets));
        runs.push_back([h = hair.back().get()] { return h->frames(8, false); });
    }
    const std::vector<std::vector<BenchRow>> times = timed(runs, with.quick ? 3 : 9);
    for (size_t i = 0; i < times.size(); ++i)
    {
        const size_t first = rows.size();
        add_rows(rows, times[i], *hair[i], with, kinds[i].note);
        rows[first].most_ms = kinds[i].most_ms;
    }
    return rows;
}

std::vector<BenchRow> bench_guides(const Benching& with)
{
    std::vector<BenchRow> rows;
    with.progress("4096 guides");
    BenchHair many(
        with.device, "bob",
        {"interpolation.guides=all", "interpolation.strands=4096", "look.self_shadow=0", "forces.repulsion=0"});
    BenchHair few(with.device, "bob", {"forces.wind=[3, 0, 0]", "forces.repulsion=1", "interpolation.strands=4096"});
    const std::vector<std::vector<BenchRow>> times =
        timed({[&] { return many.frames(24, false); }, [&] { return few.frames(24, true); }}, with.quick ? 5 : 21);
    add_rows(rows, times[0], many, with, "all simulated; bending, head");
    rows[0].most_ms = 1.0;
    const size_t first = rows.size();
    add_rows(rows, times[1], few, with, "4096 drawn of them, everything on");
    rows[first].most_ms = 1.5;
    return rows;
}

} // namespace coif
