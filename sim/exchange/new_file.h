// A file that is whole or not there at all, however large: written without a name and named when it is done.
#pragma once
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

namespace coif
{

class NewFile
{
  public:
    struct Counted
    {
    };
    // Through a link the file that it names is replaced. All throw Error when the system says no.
    explicit NewFile(const std::filesystem::path& file);
    explicit NewFile(Counted); // nothing is written: size() says how much would have been
    ~NewFile();                // takes away what was not finished
    NewFile(const NewFile&) = delete;

    void add(std::string_view bytes);
    template <typename T>
    void put(const T& value) // as it lies in memory, which is little endian on all that coif runs on
    {
        static_assert(std::is_trivially_copyable_v<T>);
        add({reinterpret_cast<const char*>(&value), sizeof value});
    }
    template <typename Number> void number(Number value) // the shortest text that reads back as the same number
    {
        char text[40];
        add({text, size_t(std::to_chars(text, text + sizeof text, value).ptr - text)});
    }
    // Lies where this one will and never has a name: for add_all_of(), which reads it.
    std::unique_ptr<NewFile> scratch() const;
    void add_all_of(NewFile& scratch);
    void put_back(uint64_t at, std::string_view bytes); // over what was written there before
    uint64_t size() const { return size_; }

    void finish(); // on the disk, and under its name

  private:
    void open(const std::filesystem::path& beside, bool named);
    void flush();
    [[noreturn]] void fault(int error, const char* doing) const;

    std::filesystem::path target_, beside_; // beside: only where the file system has no files without names
    int file_ = -1;
    uint64_t size_ = 0;
    std::string buffer_;
};

} // namespace coif
