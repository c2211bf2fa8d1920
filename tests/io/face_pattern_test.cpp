#include "io/face_pattern.h"

#include <fstream>

#include "io_test_support.h"
#include "support.h"

namespace mirrorball::detail {
namespace {

using Names = std::vector<std::string>;

// A folder with empty files: only names matter here.
class FacePattern : public testing::Test {
  protected:
    void make(const Names& names) {
        for (const std::string& face : names) std::ofstream(folder_ / (face + ".hdr"));
    }
    [[nodiscard]] std::string pattern() const { return (folder_ / "%s.hdr").string(); }
    Names found(std::optional<Projection> projection = std::nullopt) {
        Names names;
        for (const auto& file : find_face_files(pattern(), projection).files) {
            names.push_back(file.stem().string());
        }
        return names;
    }

    TemporaryFolder folder_;
};

TEST_F(FacePattern, FindsEveryScheme) {
    const std::vector<Names> schemes = {
        {"px", "nx", "py", "ny", "pz", "nz"},
        {"PX", "NX", "PY", "NY", "PZ", "NZ"},
        {"posx", "negx", "posy", "negy", "posz", "negz"},
        {"POSX", "NEGX", "POSY", "NEGY", "POSZ", "NEGZ"},
        {"right", "left", "top", "bottom", "front", "back"},
        {"Right", "Left", "Top", "Bottom", "Front", "Back"},
        {"right", "left", "up", "down", "front", "back"},
        {"rt", "lf", "up", "dn", "ft", "bk"},
        {"+x", "-x", "+y", "-y", "+z", "-z"},
        {"+X", "-X", "+Y", "-Y", "+Z", "-Z"},
        {"0", "1", "2", "3", "4", "5"},
    };
    for (const Names& scheme : schemes) {
        SCOPED_TRACE(scheme[0]);
        make(scheme);
        EXPECT_EQ(found(), scheme);
        EXPECT_EQ(find_face_files(pattern(), std::nullopt).projection, Projection::cube);
        for (const std::string& face : scheme) std::filesystem::remove(folder_ / (face + ".hdr"));
    }
}

TEST_F(FacePattern, FindsParaboloids) {
    make({"front", "back"});
    EXPECT_EQ(found(), Names({"front", "back"}));
    EXPECT_EQ(find_face_files(pattern(), std::nullopt).projection, Projection::dual_paraboloid);
}

TEST_F(FacePattern, TakesTwoOfACubesFilesForParaboloidsOnlyWhenAsked) {
    make({"right", "left", "top", "bottom", "front", "back"});
    EXPECT_EQ(found().size(), 6u);
    EXPECT_EQ(found(Projection::dual_paraboloid), Names({"front", "back"}));
}

TEST_F(FacePattern, NamesTheFileThatIsMissing) {
    make({"posx", "negx", "posy", "posz", "negz"});
    expect_error([&] { found(); }, Errc::cannot_read, {"%s.hdr", "5 of the 6", "negy.hdr"});
    // a cube that misses four faces, even where two are left that would make paraboloids
    make({"front", "back", "left"});
    std::filesystem::remove(folder_ / "posz.hdr");
    std::filesystem::remove(folder_ / "negz.hdr");
    std::filesystem::remove(folder_ / "posx.hdr");
    expect_error([&] { found(); }, Errc::cannot_read, {"right.hdr", "top.hdr", "bottom.hdr"});
}

TEST_F(FacePattern, RefusesMixtures) {
    make({"px", "nx", "py", "negy", "posz", "negz"});
    expect_error([&] { found(); }, Errc::cannot_read, {"3 of the 6", "missing"});
}

TEST_F(FacePattern, RefusesTwoWholeSets) {
    make({"px", "nx", "py", "ny", "pz", "nz"});
    make({"0", "1", "2", "3", "4", "5"});
    expect_error([&] { found(); }, Errc::cannot_read, {"two sets", "px", "0 1"});
}

TEST_F(FacePattern, ListsTheSchemesWhereThereAreNoFiles) {
    expect_error([&] { found(); }, Errc::cannot_read,
                 {"no such files", "px nx", "posx", "right", "+x", "front back"});
    expect_error([&] { found(Projection::octahedral); }, Errc::usage, {"octahedral", "only one"});
}

TEST(FaceList, IsSplitAtCommas) {
    const FaceFiles cube = split_face_list("a.hdr,b.hdr,c d.hdr,d.hdr,e.hdr,f.hdr");
    EXPECT_EQ(cube.projection, Projection::cube);
    EXPECT_EQ(cube.files[2], "c d.hdr");
    EXPECT_EQ(split_face_list("front.hdr,back.hdr").projection, Projection::dual_paraboloid);
    expect_error([] { (void)split_face_list("a.hdr,b.hdr,c.hdr"); }, Errc::usage,
                 {"3 files", "6 faces"});
}

TEST(FaceTargets, AreNamedByTheirAxes) {
    const auto cube = face_targets("out/%s-%s.hdr", Projection::cube);
    ASSERT_EQ(cube.size(), 6u);
    EXPECT_EQ(cube[0], "out/px-px.hdr");
    EXPECT_EQ(cube[5], "out/nz-nz.hdr");
    const auto paraboloids = face_targets("%s.hdr", Projection::dual_paraboloid);
    ASSERT_EQ(paraboloids.size(), 2u);
    EXPECT_EQ(paraboloids[1], "back.hdr");
    expect_error([] { (void)face_targets("%s.hdr", Projection::equirect); }, Errc::usage,
                 {"%s", "equirect"});
}

}  // namespace
}  // namespace mirrorball::detail
