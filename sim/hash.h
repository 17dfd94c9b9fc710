#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace coif
{

// 128 bits of what it is fed, against accidents only: multiply and rotate two words at a time, after MurmurHash3
// (Appleby 2011).
struct Hash
{
    uint64_t word[2] = {0x9e3779b97f4a7c15u, 0xc2b2ae3d27d4eb4fu};

    void add(const void* data, size_t bytes)
    {
        const char* from = static_cast<const char*>(data);
        for (size_t i = 0; i < bytes; i += 8)
        {
            uint64_t next = 0;
            memcpy(&next, from + i, std::min<size_t>(8, bytes - i));
            word[0] = (std::rotl(word[0] ^ next * 0x87c37b91114253d5u, 27) + word[1]) * 5 + 0x52dce729u;
            word[1] = (std::rotl(word[1] ^ next * 0x4cf5ad432745937fu, 31) + word[0]) * 5 + 0x38495ab5u;
        }
        word[0] ^= bytes;
    }
};

} // namespace coif
