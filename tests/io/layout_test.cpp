// Faces in pictures: against pictures drawn by hand, and there and back.
#include "io/layout.h"

#include "io_test_support.h"

namespace mirrorball::detail {
namespace {

constexpr Layout kLayouts[] = {Layout::horizontal_cross, Layout::vertical_cross,
                               Layout::horizontal_strip, Layout::vertical_strip,
                               Layout::side_by_side,     Layout::side_by_side_turned};

// A face of 2 x 2 texels, one channel: `label` throughout but for the top left corner, 10 more.
Image labelled_face(float label) {
    Image image(2, 2, 1);
    for (float& value : image.values()) value = label;
    *image.at(0, 0) += 10;
    return image;
}

// The faces 1 2 3 4 5 6 stand for +X -X +Y -Y +Z -Z (and front and back are 1 and 2).
Image drawn(int width, int height, std::initializer_list<float> values) {
    Image image(width, height, 1);
    std::copy(values.begin(), values.end(), image.values().begin());
    return image;
}

Image drawn(Layout layout) {
    switch (layout) {
        case Layout::horizontal_cross:
            return drawn(8, 6, {0,  0, 13, 3, 0,  0, 0,  0,  //
                                0,  0, 3,  3, 0,  0, 0,  0,  //
                                12, 2, 15, 5, 11, 1, 16, 6,  //
                                2,  2, 5,  5, 1,  1, 6,  6,  //
                                0,  0, 14, 4, 0,  0, 0,  0,  //
                                0,  0, 4,  4, 0,  0, 0,  0});
        case Layout::vertical_cross:
            return drawn(6, 8, {0,  0, 13, 3,  0,  0,    //
                                0,  0, 3,  3,  0,  0,    //
                                12, 2, 15, 5,  11, 1,    //
                                2,  2, 5,  5,  1,  1,    //
                                0,  0, 14, 4,  0,  0,    //
                                0,  0, 4,  4,  0,  0,    //
                                0,  0, 6,  6,  0,  0,    // upside down: its top left is
                                0,  0, 6,  16, 0,  0});  // at the bottom right
        case Layout::horizontal_strip:
            return drawn(12, 2, {11, 1, 12, 2, 13, 3, 14, 4, 15, 5, 16, 6,  //
                                 1,  1, 2,  2, 3,  3, 4,  4, 5,  5, 6,  6});
        case Layout::vertical_strip:
            return drawn(2, 12, {11, 1, 1, 1, 12, 2, 2, 2, 13, 3, 3, 3,  //
                                 14, 4, 4, 4, 15, 5, 5, 5, 16, 6, 6, 6});
        case Layout::side_by_side:
            return drawn(4, 2,
                         {11, 1, 12, 2,  //
                          1, 1, 2, 2});
        default:
            return drawn(4, 2,
                         {11, 1, 2, 2,  //
                          1, 1, 2, 12});
    }
}

TEST(Layout, CutsFacesFromDrawnPictures) {
    for (const Layout layout : kLayouts) {
        SCOPED_TRACE(name(layout));
        const Arrangement& a = arrangement(layout);
        ASSERT_EQ(int(a.cells.size()), face_count(a.projection));
        for (int face = 0; face < face_count(a.projection); ++face) {
            expect_equal(cut_face(drawn(layout), a, face), labelled_face(float(face + 1)));
        }
    }
}

TEST(Layout, PastesFacesIntoDrawnPictures) {
    for (const Layout layout : kLayouts) {
        SCOPED_TRACE(name(layout));
        const Arrangement& a = arrangement(layout);
        Image picture(a.columns * 2, a.rows * 2, 1);
        for (int face = 0; face < face_count(a.projection); ++face) {
            paste_face(picture, labelled_face(float(face + 1)), a, face);
        }
        expect_equal(picture, drawn(layout));
    }
}

TEST(Layout, KeepsChannelsTogetherWhereFacesAreTurned) {
    const Arrangement& a = arrangement(Layout::vertical_cross);
    const Image face = numbered_image(3, 3);
    Image picture(9, 12, 3);
    paste_face(picture, face, a, 5);
    EXPECT_EQ(picture.rgb(5, 11), face.rgb(0, 0));
    expect_equal(cut_face(picture, a, 5), face);
}

// Neighbouring faces of a cross continue each other: that is what a cross is for. A texel of one
// and the texel beside it in the picture look in nearly the same direction.
TEST(Layout, CrossesContinueAcrossTheirFolds) {
    constexpr int size = 16;
    const auto direction = [](const Arrangement& a, int x, int y) -> std::optional<Vec3d> {
        for (int face = 0; face < 6; ++face) {
            const Cell& cell = a.cells[face];
            if (x / size != cell.column || y / size != cell.row) continue;
            double s = (x % size + 0.5) / size, t = (y % size + 0.5) / size;
            if (cell.turned) s = 1 - s, t = 1 - t;
            return Cube::direction(FacePoint<double>{face, s, t});
        }
        return std::nullopt;
    };
    for (const Layout layout : {Layout::horizontal_cross, Layout::vertical_cross}) {
        const Arrangement& a = arrangement(layout);
        int pair_count = 0;
        for (int y = 0; y < a.rows * size; ++y) {
            for (int x = 0; x < a.columns * size; ++x) {
                const auto here = direction(a, x, y);
                const auto right = direction(a, x + 1, y), below = direction(a, x, y + 1);
                // the largest step between neighbours on one face is 2 / size, at its centre
                if (here && right) {
                    EXPECT_LT((*here - *right).length(), 2.01 / size);
                }
                if (here && below) {
                    EXPECT_LT((*here - *below).length(), 2.01 / size);
                }
                pair_count += (here && right) + (here && below);
            }
        }
        EXPECT_EQ(pair_count,
                  6 * 2 * size * (size - 1) + 5 * size);  // a tree of six has five folds
    }
}

TEST(Layout, IsKnownByItsShape) {
    EXPECT_EQ(layout_by_shape(Projection::cube, 400, 300), Layout::horizontal_cross);
    EXPECT_EQ(layout_by_shape(Projection::cube, 300, 400), Layout::vertical_cross);
    EXPECT_EQ(layout_by_shape(Projection::cube, 6, 1), Layout::horizontal_strip);
    EXPECT_EQ(layout_by_shape(Projection::cube, 1, 6), Layout::vertical_strip);
    EXPECT_EQ(layout_by_shape(Projection::dual_paraboloid, 64, 32), Layout::side_by_side);
    EXPECT_EQ(layout_by_shape(Projection::cube, 401, 300), std::nullopt);
    EXPECT_EQ(layout_by_shape(Projection::cube, 200, 100), std::nullopt);
    EXPECT_EQ(layout_by_shape(Projection::dual_paraboloid, 64, 64), std::nullopt);
}

}  // namespace
}  // namespace mirrorball::detail
