// Small pictures of presets, drawn by the program itself in another process.
#include "app/thumbnails.h"
#include "tests/commands.h"

#include <chrono>
#include <thread>

using namespace coif;
using namespace coif::test;

namespace
{
class ThumbnailsOf : public Commands
{
  protected:
    // Until nothing is left to do for this style.
    static Thumbnails::Entry settled(Thumbnails& thumbnails, const fs::path& style, int seconds = 90)
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
        double longest = 0.0;
        while (std::chrono::steady_clock::now() < end && thumbnails.of(style).state == Thumbnails::Entry::WAITING)
        {
            const auto before = std::chrono::steady_clock::now();
            thumbnails.work();
            longest =
                std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count());
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        EXPECT_LT(longest, 1.0) << "the window goes on meanwhile";
        return thumbnails.of(style);
    }
    size_t pictures() const
    {
        size_t count = 0;
        std::error_code error;
        for (const auto& entry : fs::directory_iterator(folder / "cache", error))
            count += entry.path().extension() == ".png";
        return count;
    }
    const fs::path program = COIF_BUILD_FOLDER "/coif";
};
} // namespace

TEST_F(ThumbnailsOf, a_style_is_drawn_once_and_again_when_it_or_what_lies_in_the_cache_has_changed)
{
    Thumbnails::Entry first;
    {
        Thumbnails thumbnails(folder / "cache", program, "");
        EXPECT_EQ(thumbnails.of(folder / "small.toml").state, Thumbnails::Entry::WAITING);
        first = settled(thumbnails, folder / "small.toml");
        ASSERT_EQ(first.state, Thumbnails::Entry::DRAWN) << first.why;
        EXPECT_EQ(first.image.width, Thumbnails::kSize);
        EXPECT_EQ(pictures(), 1u);
        // The same content under another name is the same picture.
        write("copy.toml", contents("small.toml"));
        EXPECT_EQ(settled(thumbnails, folder / "copy.toml").key, first.key);
        EXPECT_EQ(pictures(), 1u);
        write("small.toml", contents("small.toml") + "[strand]\nlength = 0.1\n");
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(90);
        while (std::chrono::steady_clock::now() < end && thumbnails.of(folder / "small.toml").version == first.version)
        {
            thumbnails.work();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        EXPECT_EQ(pictures(), 2u) << thumbnails.of(folder / "small.toml").why;
        EXPECT_NE(thumbnails.of(folder / "small.toml").image.pixels, first.image.pixels);
    }
    const fs::path kept = folder / "cache" / (first.key + ".png");
    const auto drawn = fs::last_write_time(kept);
    Thumbnails again(folder / "cache", program, "");
    EXPECT_EQ(settled(again, folder / "copy.toml").image.pixels, first.image.pixels);
    EXPECT_EQ(fs::last_write_time(kept), drawn) << "it was not drawn again";
    std::ofstream(kept) << "spoilt";
    Thumbnails third(folder / "cache", program, "");
    const Thumbnails::Entry mended = settled(third, folder / "copy.toml");
    ASSERT_EQ(mended.state, Thumbnails::Entry::DRAWN) << mended.why;
    EXPECT_EQ(mended.image.pixels, first.image.pixels);
}

TEST_F(ThumbnailsOf, what_cannot_be_drawn_is_told_and_not_tried_for_ever)
{
    write("broken.toml", "[strand]\nlenght = 1\n");
    write("lost.toml", "[scalp]\nmesh = \"nowhere.obj\"\n");
    Thumbnails thumbnails(folder / "cache", program, "");
    const Thumbnails::Entry broken = settled(thumbnails, folder / "broken.toml");
    EXPECT_EQ(broken.state, Thumbnails::Entry::FAILED);
    EXPECT_NE(broken.why.find("broken.toml:2:1"), std::string::npos) << broken.why;
    EXPECT_NE(settled(thumbnails, folder / "lost.toml").why.find("nowhere.obj"), std::string::npos);
    EXPECT_NE(settled(thumbnails, folder / "none.toml").why.find("no such file"), std::string::npos);
    for (int i = 0; i < 20; ++i)
        EXPECT_FALSE(thumbnails.work());
    EXPECT_FALSE(thumbnails.busy());

    Thumbnails no_device(folder / "cache", program, "no such device");
    const Thumbnails::Entry refused = settled(no_device, folder / "small.toml");
    EXPECT_EQ(refused.state, Thumbnails::Entry::FAILED);
    EXPECT_NE(refused.why.find("no such device"), std::string::npos) << refused.why;
    Thumbnails no_program(folder / "cache", "/nowhere/coif", "");
    EXPECT_EQ(settled(no_program, folder / "small.toml").state, Thumbnails::Entry::FAILED);
    write("file", "");
    Thumbnails no_folder(folder / "file", program, "");
    EXPECT_NE(settled(no_folder, folder / "small.toml").why.find("cannot be"), std::string::npos);
}
