// What a traced still has come to, kept in a file beside it so that more samples can be added later.
#pragma once
#include "app/image.h"
#include "app/traced/tracer.h"

#include <filesystem>
#include <optional>

namespace coif
{

// "bob.png" -> "bob.traced"
std::filesystem::path record_of(const std::filesystem::path& picture);

// What an earlier run has left, of any input and size; none if there is no file. Throws Error for a file that is no
// record, which it would be a pity to write over.
struct Record
{
    Hash of; // hash_of() its scene
    Accumulation picture;
};
std::optional<Record> read_record(const std::filesystem::path& file);
void write_record(const std::filesystem::path& file, const Hash& of, const Accumulation& picture);

// The mean of the samples: linear, premultiplied.
LinearImage mean_of(const Accumulation& picture);

} // namespace coif
