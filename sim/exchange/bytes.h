#pragma once
#include "sim/error.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace coif
{

static_assert(std::endian::native == std::endian::little, "files of hair are little endian, and read as they lie");

// A file's bytes, none of them read beyond their end.
struct Bytes
{
    std::string_view all;
    const std::string& name; // of the file

    // `count` values of this many bytes each lie there?
    bool holds(uint64_t at, uint64_t count, uint64_t size) const
    {
        return at <= all.size() && count <= (all.size() - at) / size;
    }

    // Throws Error saying that the file ends before `what`.
    void need(uint64_t at, uint64_t count, uint64_t size, const char* what) const
    {
        if (!holds(at, count, size))
            throw fail("{}: at byte {}: the file's {} bytes end before its {}: it is damaged or was not copied whole",
                       name, at, all.size(), what);
    }

    template <typename T> T value(uint64_t at, const char* what) const
    {
        need(at, 1, sizeof(T), what);
        T v;
        memcpy(&v, all.data() + at, sizeof v);
        return v;
    }

    template <typename T> std::vector<T> values(uint64_t at, uint64_t count, const char* what) const
    {
        need(at, count, sizeof(T), what);
        std::vector<T> v(count);
        if (count > 0)
            memcpy(v.data(), all.data() + at, count * sizeof(T));
        return v;
    }
};

} // namespace coif
