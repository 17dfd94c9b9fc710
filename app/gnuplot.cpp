#include "app/gnuplot.h"

#include "sim/error.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace coif
{

int run_gnuplot(const std::filesystem::path& folder, const std::string& script, const std::string& words)
{
    const pid_t child = fork();
    if (child < 0)
        throw fail("gnuplot could not be started: the system takes no more processes");
    if (child == 0)
    {
        const int log = chdir(folder.c_str()) == 0 ? open(words.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644) : -1;
        if (log >= 0 && dup2(log, STDOUT_FILENO) >= 0 && dup2(log, STDERR_FILENO) >= 0)
            execlp("gnuplot", "gnuplot", script.c_str(), static_cast<char*>(nullptr));
        _exit(errno == ENOENT ? 127 : 126);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 126;
    return code == 127 ? -1 : code;
}

} // namespace coif
