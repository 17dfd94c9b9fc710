#include "app/batch/run.h"

#include "app/batch/results.h"
#include "sim/hairstyle.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <optional>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace coif
{

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock; // which no jump of the time of day moves

namespace
{
struct Running
{
    const Task* task;
    std::string key, stem;
    fs::path folder; // to work in
    int attempt;
    Clock::time_point begin; // of the first attempt
    pid_t process;
};
} // namespace

static volatile std::sig_atomic_t asked_to_stop = 0;
static void ask_to_stop(int signal) { asked_to_stop = signal; }

// Processors that a task may use.
static int share_of(const RunOptions& wanted)
{
    if (wanted.threads > 0)
        return wanted.threads;
    int all = 0;
    if (const char* slurm = std::getenv("SLURM_CPUS_PER_TASK"))
        all = std::atoi(slurm);
    cpu_set_t mine;
    if (all < 1 && sched_getaffinity(0, sizeof mine, &mine) == 0)
        all = CPU_COUNT(&mine);
    return std::max(1, all / wanted.jobs);
}

// The environment with PoCL's and llvmpipe's threads bounded, unless it says itself how many there are to be.
static std::vector<std::string> environment_of(int threads)
{
    std::vector<std::string> all;
    for (char** one = environ; *one; ++one)
        all.emplace_back(*one);
    for (const char* name : {"POCL_MAX_PTHREAD_COUNT", "LP_NUM_THREADS"})
        if (!std::getenv(name))
            all.push_back(fmt::format("{}={}", name, threads));
    return all;
}

static std::vector<char*> pointers(const std::vector<std::string>& words)
{
    std::vector<char*> all;
    for (const std::string& word : words)
        all.push_back(const_cast<char*>(word.c_str()));
    all.push_back(nullptr);
    return all;
}

// Throws Error when there can be no more processes.
static pid_t start(const Running& one, const fs::path& log, const std::vector<std::string>& environment)
{
    const std::string made = (one.folder / one.task->name).string(), told = log.string();
    std::vector<std::string> words = one.task->words;
    words.insert(words.begin(), "coif");
    if (!one.task->prints)
        words.insert(words.end(), {"-o", made});
    const std::vector<char*> arguments = pointers(words), variables = pointers(environment);
    const pid_t runner = getpid();
    const pid_t process = fork();
    if (process < 0)
        throw fail("task {} cannot be started: {}", one.task->number, std::strerror(errno));
    if (process > 0)
        return process;
    // The child: only what may be called after a fork. It dies with the runner, even of kill -9.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != runner)
        _exit(126);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        std::signal(signal, SIG_DFL);
    const int in = open("/dev/null", O_RDONLY), err = open(told.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
    const int out = one.task->prints ? open(made.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666) : err;
    if (in < 0 || err < 0 || out < 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0)
        _exit(125);
    for (const int opened : {in, out, err})
        if (opened > 2)
            close(opened);
    execve("/proc/self/exe", arguments.data(), variables.data());
    _exit(127);
}

// What keeps the folder of a task that ended with status 0 from being its result; empty: nothing.
static std::string fault_of(const Running& one)
{
    std::error_code error;
    const fs::path made = one.folder / one.task->name;
    if (!fs::is_regular_file(made, error))
        return fmt::format("it made no file {}", one.task->name);
    for (const auto& entry : fs::directory_iterator(one.folder, error))
        if (entry.path() != made)
            return fmt::format("it made {} too, and a task makes one file", entry.path().filename().string());
    if (key_of(*one.task) != one.key)
        return "a file that it reads was changed meanwhile; run again";
    return {};
}

static std::string last_line_of(const fs::path& log)
{
    std::string text;
    try
    {
        text = read_file(log);
    }
    catch (const Error&)
    {
        return {};
    }
    text.erase(text.find_last_not_of("\r\n ") + 1);
    return text.substr(std::min(text.size(), text.rfind('\n') + 1));
}

static std::string ended_by(int status)
{
    if (WIFSIGNALED(status))
        return fmt::format("killed by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    switch (WEXITSTATUS(status))
    {
    case 125:
        return "its files cannot be opened; is the disk full?";
    case 127:
        return "coif itself cannot be started";
    default:
        return fmt::format("status {}", WEXITSTATUS(status));
    }
}

namespace
{
struct Runner
{
    const RunOptions& wanted;
    std::vector<std::string> environment = environment_of(share_of(wanted));
    std::vector<Running> running = {};
    std::map<std::string, std::vector<Found>> results = {};
    Clock::time_point looked = {};
    int done = 0, kept = 0, failed = 0;

    void tell(const Task& task, const std::string& how) const
    {
        if (!wanted.told)
            return;
        fmt::print("{} {}\n", task.number, how);
        std::fflush(stdout); // a line a task, when it ends, wherever it goes
    }

    fs::path log_of(const std::string& stem) const { return wanted.folder / (stem + ".log"); }

    // Is a whole result there, of this run, one before, or one that goes on beside it?
    bool is_done(const std::string& stem)
    {
        if (const auto now = Clock::now(); results.empty() || now - looked > std::chrono::seconds(2))
        {
            results = results_in(wanted.folder);
            looked = now;
        }
        const auto found = results.find(stem);
        if (found == results.end())
            return false;
        bool whole = false;
        for (const Found& one : found->second)
            if (is_whole(one))
                whole = true;
            else if (std::error_code error; fs::exists(one.file, error))
            {
                fmt::print(stderr, "coif: {}: has been changed since it was made; it is made again\n",
                           one.file.string());
                fs::remove(one.file, error);
            }
        return whole;
    }

    void end(const Running& one, const std::string& fault)
    {
        std::error_code ignored;
        fs::remove_all(one.folder, ignored);
        if (fault.empty())
        {
            ++done;
            const std::chrono::duration<double> spent = Clock::now() - one.begin;
            return tell(*one.task, fmt::format("done {:.2f}s", spent.count()));
        }
        ++failed;
        const std::string why = last_line_of(log_of(one.stem));
        tell(*one.task,
             fmt::format("failed: {}{}{}; {}", fault, why.empty() ? "" : ": ", why, log_of(one.stem).string()));
    }

    // False where it fails for good.
    bool attempt(Running& one)
    {
        try
        {
            std::error_code ignored;
            fs::remove_all(one.folder, ignored);
            make_folder(one.folder);
            one.process = start(one, log_of(one.stem), environment);
            return true;
        }
        catch (const Error& e)
        {
            end(one, e.what());
            return false;
        }
    }

    void begin(const Task& task)
    {
        const std::string key = key_of(task), stem = stem_of(task, key);
        if (is_done(stem))
        {
            ++kept;
            return tell(task, "kept");
        }
        Running one{&task, key, stem, unfinished_folder(wanted.folder, stem), 1, Clock::now(), 0};
        if (attempt(one))
            running.push_back(std::move(one));
    }

    void wait_for_one()
    {
        int status = 0;
        const pid_t process = waitpid(-1, &status, 0);
        const auto it = std::ranges::find(running, process, &Running::process);
        if (process <= 0 || it == running.end())
            return; // a signal
        std::string fault;
        if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
            fault = ended_by(status);
        else
            try
            {
                fault = fault_of(*it);
                if (fault.empty())
                    keep_result(it->folder / it->task->name, wanted.folder, it->stem,
                                fs::path(it->task->name).extension().string());
            }
            catch (const Error& e)
            {
                fault = e.what();
            }
        if (!fault.empty() && it->attempt < wanted.tries && !asked_to_stop)
        {
            ++it->attempt;
            if (!attempt(*it))
                running.erase(it);
            return;
        }
        end(*it, fault);
        running.erase(it);
    }

    void stop()
    {
        for (const Running& one : running)
            kill(one.process, SIGKILL);
        for (const Running& one : running)
        {
            while (waitpid(one.process, nullptr, 0) < 0 && errno == EINTR)
            {
            }
            std::error_code ignored;
            fs::remove_all(one.folder, ignored);
        }
        running.clear();
    }
};
} // namespace

int run_tasks(const std::vector<Task>& tasks, const RunOptions& wanted)
{
    make_folder(wanted.folder);
    std::vector<const Task*> mine;
    const std::string program = digest_of_program();
    for (const Task& task : tasks)
        if (wanted.shard.holds(task))
        {
            key_of(task, program); // what cannot be read is told before any work
            mine.push_back(&task);
        }

    struct sigaction stops = {}, before[3];
    stops.sa_handler = ask_to_stop; // without SA_RESTART: waiting ends
    const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    asked_to_stop = 0;
    for (int i = 0; i < 3; ++i)
        if (sigaction(signals[i], &stops, &before[i]) == 0 && before[i].sa_handler == SIG_IGN)
            sigaction(signals[i], &before[i], nullptr); // nohup's wish
    Runner runner{wanted};
    for (auto next = mine.begin(); (next != mine.end() || !runner.running.empty()) && !asked_to_stop;)
        if (next != mine.end() && int(runner.running.size()) < wanted.jobs)
            runner.begin(**next++);
        else
            runner.wait_for_one();
    runner.stop();
    for (int i = 0; i < 3; ++i)
        sigaction(signals[i], &before[i], nullptr);
    if (asked_to_stop)
    {
        fmt::print(stderr, "coif: broken off; the same call goes on with what is left\n");
        raise(asked_to_stop);
    }
    if (wanted.told)
        fmt::print(stderr, "{} of {} tasks done, {} kept, {} failed\n", runner.done, mine.size(), runner.kept,
                   runner.failed);
    return runner.failed ? 1 : 0;
}

static fs::path scratch_folder()
{
    std::string name = (fs::temp_directory_path() / "coif-run-XXXXXX").string();
    if (!mkdtemp(name.data()))
        throw fail("{}: the folder cannot be made: {}", name, std::strerror(errno));
    return name;
}

RunHere::RunHere(const std::vector<std::string>& lines, int jobs) : folder_(scratch_folder())
{
    tasks_ = parse_list(fmt::format("{}\n", fmt::join(lines, "\n")), "tasks", [](const auto&) {});
    const std::string program = digest_of_program();
    for (const Task& task : tasks_)
        stems_.push_back(stem_of(task, key_of(task, program)));
    RunOptions wanted;
    wanted.folder = folder_;
    wanted.jobs = jobs;
    wanted.told = false;
    run_tasks(tasks_, wanted);
}

RunHere::~RunHere()
{
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

fs::path RunHere::result(size_t i, std::string* fault) const
{
    const auto results = results_in(folder_);
    const auto found = results.find(stems_[i]);
    if (found != results.end() && is_whole(found->second[0]))
        return found->second[0].file;
    if (fault)
        *fault = last_line_of(folder_ / (stems_[i] + ".log"));
    return {};
}

} // namespace coif
