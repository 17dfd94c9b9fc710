#include "sim/exchange/new_file.h"

#include "sim/error.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace coif
{

namespace fs = std::filesystem;

static constexpr size_t kBuffer = size_t(1) << 20;

NewFile::NewFile(const fs::path& file)
{
    std::error_code error;
    target_ = fs::is_symlink(file, error) ? fs::weakly_canonical(file, error) : file;
    const auto there = fs::status(target_, error);
    if (fs::is_directory(there))
        throw fail("{}: is a folder; say the name of a file in it", file.string());
    if (fs::exists(there) && !fs::is_regular_file(there))
        throw fail("{}: is no plain file; hair is written to those only", file.string());
    open(target_.string() + fmt::format(".{}.new", getpid()), true);
}

NewFile::NewFile(Counted) {}

std::unique_ptr<NewFile> NewFile::scratch() const
{
    auto made = std::make_unique<NewFile>(Counted());
    if (file_ >= 0)
    {
        made->target_ = target_;
        made->open(target_.string() + fmt::format(".{}.part", getpid()), false);
    }
    return made;
}

void NewFile::open(const fs::path& beside, bool named)
{
    const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
    file_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    if (file_ < 0) // a file system that does not know this, or a folder that is not there
    {
        file_ = ::open(beside.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
        if (file_ < 0)
            throw fail("{}: cannot be written: {}; is its folder there, and writable?", target_.string(),
                       std::generic_category().message(errno));
        if (named)
            beside_ = beside;
        else
            unlink(beside.c_str());
    }
    buffer_.reserve(kBuffer);
}

NewFile::~NewFile()
{
    if (file_ >= 0)
        close(file_);
    if (!beside_.empty())
        unlink(beside_.c_str());
}

void NewFile::fault(int error, const char* doing) const
{
    throw fail("{}: cannot be {}: {}; make room, or save elsewhere", target_.string(), doing,
               std::generic_category().message(error));
}

static bool write_all(int file, const char* bytes, size_t count, int64_t at)
{
    while (count > 0)
    {
        const ssize_t done = pwrite(file, bytes, count, at);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            return false;
        bytes += done;
        count -= size_t(done);
        at += done;
    }
    return true;
}

void NewFile::flush()
{
    if (file_ >= 0 && !write_all(file_, buffer_.data(), buffer_.size(), int64_t(size_ - buffer_.size())))
        fault(errno, "written");
    buffer_.clear();
}

void NewFile::add(std::string_view bytes)
{
    size_ += bytes.size();
    if (file_ < 0)
        return;
    buffer_.append(bytes);
    if (buffer_.size() >= kBuffer)
        flush();
}

void NewFile::put_back(uint64_t at, std::string_view bytes)
{
    flush();
    if (file_ >= 0 && !write_all(file_, bytes.data(), bytes.size(), int64_t(at)))
        fault(errno, "written");
}

void NewFile::add_all_of(NewFile& scratch)
{
    scratch.flush();
    if (scratch.file_ < 0)
        size_ += scratch.size_;
    std::string part(kBuffer, 0);
    for (uint64_t at = 0; scratch.file_ >= 0 && at < scratch.size_;)
    {
        const ssize_t got = pread(scratch.file_, part.data(), part.size(), int64_t(at));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            fault(errno, "read back");
        add({part.data(), size_t(got)});
        at += uint64_t(got);
    }
}

void NewFile::finish()
{
    flush();
    if (file_ < 0)
        return;
    struct stat old;
    if (stat(target_.c_str(), &old) == 0)
        fchmod(file_, old.st_mode & 07777); // what was there keeps its permissions
    if (fsync(file_) != 0)
        fault(errno, "written");
    if (beside_.empty())
    {
        beside_ = target_.string() + fmt::format(".{}.new", getpid());
        unlink(beside_.c_str());
        const std::string open_file = fmt::format("/proc/self/fd/{}", file_);
        if (linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, beside_.c_str(), AT_SYMLINK_FOLLOW) != 0)
        {
            const int error = errno;
            beside_.clear();
            fault(error, "written");
        }
    }
    if (rename(beside_.c_str(), target_.c_str()) != 0)
        fault(errno, "written");
    beside_.clear();
    if (close(std::exchange(file_, -1)) != 0)
        fault(errno, "written");
}

} // namespace coif
