// docs/gallery/README.md: its pictures are there, and its commands are ones that the program takes.
// They are not run to their ends, which is what `make gallery` does.
#include <iterator>
#include <regex>
#include <set>

#include <mirrorball/io.h>

#include "program.h"

namespace mirrorball {
namespace {

const std::filesystem::path kGallery =
    std::filesystem::path(MIRRORBALL_SOURCE_DIR) / "docs" / "gallery";

// The lines that scripts/gallery.sh runs.
std::vector<std::string> command_lines() {
    std::vector<std::string> lines;
    std::istringstream text(contents(kGallery / "README.md"));
    bool in_block = false;
    for (std::string line; std::getline(text, line);) {
        if (line.starts_with("```")) {
            in_block = line == "```sh";
        } else if (in_block) {
            lines.push_back(line);
        }
    }
    return lines;
}

// No word of the gallery's has a space in it.
std::vector<std::string> words_of(std::string line) {
    std::erase(line, '\'');
    std::istringstream text(line);
    return {std::istream_iterator<std::string>(text), {}};
}

std::set<std::string> pictures() {
    std::set<std::string> names;
    const std::string text = contents(kGallery / "README.md");
    const std::regex link(R"(!\[[^\]]*\]\(([^)]*)\))");
    for (std::sregex_iterator i(text.begin(), text.end(), link), end; i != end; ++i)
        names.insert((*i)[1]);
    return names;
}

TEST(Gallery, PicturesAreThere) {
    EXPECT_GT(pictures().size(), 30u);
    for (const std::string& name : pictures()) {
        const std::filesystem::path file = kGallery / name;
        ASSERT_TRUE(std::filesystem::exists(file)) << name << "; `make gallery` makes it";
        if (file.extension() == ".png") {
            EXPECT_GT(read_image(file).width(), 200) << name;
        } else if (file.extension() == ".webp") {
            EXPECT_EQ(contents(file).find("RIFF"), 0u) << name;
        } else {
            EXPECT_EQ(contents(file).find("<svg"), 0u) << name;
        }
    }
}

TEST(Gallery, EveryPictureHasACommand) {
    std::string commands;
    for (const std::string& line : command_lines()) commands += line + "\n";
    for (const std::string& name : pictures()) {
        // Animations are put together by other programs; scenes bring pictures of their own.
        if (name.ends_with(".webp") || name.starts_with("../scenes/")) continue;
        const std::filesystem::path file =
            (std::filesystem::path("docs/gallery") / name).lexically_normal();
        const bool copied = file.parent_path().filename() == "methods";
        const std::string target = copied ? file.parent_path().string() : file.string();
        EXPECT_NE(commands.find(target), std::string::npos) << name;
    }
}

// Into a folder that is not there: the program reads the whole line, and stops before any work.
TEST(Gallery, CommandsAreTaken) {
    int count = 0;
    for (const std::string& line : command_lines()) {
        std::vector<std::string> words = words_of(line);
        ASSERT_FALSE(words.empty());
        if (words.front() == "cp") continue;
        ASSERT_EQ(words.front(), "mirrorball") << line;
        words.erase(words.begin());
        for (std::size_t i = 0; i + 1 < words.size(); ++i) {
            if (words[i] == "-o" || words[i] == "--plot")
                words[i + 1] = "/there-is-no-such-folder/picture" +
                               std::filesystem::path(words[i + 1]).extension().string();
        }
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 4) << line << "\n" << outcome.err;
        ++count;
    }
    EXPECT_GT(count, 20);
}

// Scenes whose pictures are not made first.
TEST(Gallery, ScenesAreDrawn) {
    const TemporaryFolder folder;
    for (const char* name : {"still-life", "phong", "fresnel"}) {
        const std::string scene =
            (kGallery.parent_path() / "scenes" / (std::string(name) + ".json")).string();
        const Outcome outcome =
            run({"render", scene, "-o", (folder / "scene.png").string(), "--env", "builtin:white",
                 "--map-size", "16", "--width", "64", "--height", "36", "--samples", "1"});
        EXPECT_EQ(outcome.code, 0) << name << ": " << outcome.err;
    }
}

}  // namespace
}  // namespace mirrorball
