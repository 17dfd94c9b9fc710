// What moving hair takes: a whole head of strands, and few of which many are drawn.
#include "app/bench/hair.h"

#include <fmt/format.h>

namespace coif
{

// Rows of one kind of hair, with what is known of it besides times.
static void add_rows(std::vector<BenchRow>& all, std::vector<BenchRow> rows, BenchHair& hair, const Benching& with,
                     const std::string& note)
{
    const std::map<std::string, double> traffic = traffic_of(hair.solver()), operations = operations_of(hair.solver());
    for (BenchRow& row : rows)
    {
        row.note = note;
        row.strands = hair.strands();
        row.cores = with.machine.compute_units;
        const auto bytes = traffic.find(row.what);
        if (bytes != traffic.end())
            row.bytes = bytes->second;
        const auto counted = operations.find(row.what);
        if (counted != operations.end())
            row.operations = counted->second;
        all.push_back(row);
    }
}

// The bob, but straight: waves that are bends of the strands are a price of their own.
static std::vector<std::string> straight_bob(int strands, const std::vector<std::string>& more = {})
{
    std::vector<std::string> sets = {"interpolation.guides=all", fmt::format("interpolation.strands={}", strands),
                                     "look.self_shadow=0",       "forces.repulsion=0",
                                     "wave.normal_amplitude=0",  "wave.binormal_amplitude=0"};
    sets.insert(sets.end(), more.begin(), more.end());
    return sets;
}

std::vector<BenchRow> bench_whole_head(const Benching& with)
{
    constexpr int kStrands = 102400;
    // Positions and velocities, read and written once.
    const double floor_ms = 1e3 * kStrands * 16.0 * 3.0 * sizeof(float) * 4.0 / with.machine.bandwidth;
    struct HeadCase
    {
        const char* note;
        std::vector<std::string> sets;
        bool with_bodies;
        double most_ms;
        bool far = false;
    };
    const HeadCase cases[] = {
        {"lengths alone", straight_bob(kStrands, {"bending.droop=10000"}), false, 5.0 * floor_ms},
        {"bending, head", straight_bob(kStrands), true, 1000.0 / 60.0},
        {"bending, head, tolerance 1 %: courant 1.8", straight_bob(kStrands, {"solver.courant=1.8"}), true, NAN},
        {"bending, head, far away: half the nodes", straight_bob(kStrands, {"solver.far_tolerance=20"}), true, NAN,
         true},
        {"bending, head, wind, repulsion", straight_bob(kStrands, {"forces.wind=[3, 0, 0]", "forces.repulsion=1"}),
         true, 1000.0 / 30.0},
        {"bending to waves, head",
         straight_bob(kStrands, {"wave.normal_amplitude=0.002", "wave.binormal_amplitude=0.002"}), true, NAN},
    };
    std::vector<BenchRow> rows;
    std::vector<std::unique_ptr<BenchHair>> hair;
    std::vector<std::function<PassTimes()>> runs;
    for (const HeadCase& each : cases)
    {
        with.progress(each.note);
        hair.push_back(std::make_unique<BenchHair>(with.device, "bob", each.sets, each.with_bodies));
        if (each.far)
            hair.back()->go_far();
        runs.push_back([h = hair.back().get()] { return h->frames(8, false); });
    }
    with.progress("102,400 strands");
    const std::vector<std::vector<BenchRow>> times = timed(runs, with.quick ? 3 : 9);
    for (size_t i = 0; i < times.size(); ++i)
    {
        const size_t first = rows.size();
        add_rows(rows, times[i], *hair[i], with, cases[i].note);
        rows[first].most_ms = cases[i].most_ms;
    }
    return rows;
}

// The same hair once its head has come to a stop. Each second comes but once, so it is timed once.
static void add_rest(std::vector<BenchRow>& rows, BenchHair& hair, const Benching& with)
{
    with.progress("at rest");
    for (int second = 1; second <= 8; ++second)
    {
        BenchRow row;
        row.what = "frame";
        row.ms = row.low = row.high = hair.rest(1.0).front().second;
        row.strands = hair.strands();
        row.cores = with.machine.compute_units;
        row.note = fmt::format("second {} of rest: {} of {} blocks awake at its end", second,
                               hair.solver().blocks_awake(), hair.solver().groom().blocks);
        if (second == 1 || second % 2 == 0)
            rows.push_back(row);
    }
}

std::vector<BenchRow> bench_guides(const Benching& with)
{
    std::vector<BenchRow> rows;
    with.progress("4096 strands");
    BenchHair many(with.device, "bob", straight_bob(4096));
    BenchHair few(with.device, "bob",
                  {"forces.wind=[3, 0, 0]", "forces.repulsion=1", "interpolation.strands=4096",
                   "look.level=kajiya_kay"}); // which has its shadows here
    const std::vector<std::vector<BenchRow>> times =
        timed({[&] { return many.frames(24, false); }, [&] { return few.frames(24, true); }}, with.quick ? 5 : 21);
    add_rows(rows, times[0], many, with, "all simulated; bending, head");
    rows[0].most_ms = 1.0;
    const size_t first = rows.size();
    add_rows(rows, times[1], few, with, "4096 drawn of them, everything on");
    rows[first].most_ms = 1.5;
    add_rest(rows, many, with);
    return rows;
}

} // namespace coif
