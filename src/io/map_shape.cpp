#include "map_shape.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <mirrorball/error.h>

#include "ball_crop.h"
#include "face_words.h"
#include "layout.h"

namespace mirrorball::detail {
namespace {

class Decision {
  public:
    Decision(const std::string& source, const StoredPictures& stored, const MapWords& words,
             const MapReadOptions& options)
        : source_(source),
          stored_(stored),
          words_(words),
          options_(options) {
        width_ = options.crop ? crop_size(*options.crop) : stored.width;
        height_ = options.crop ? width_ : stored.height;
        files_word_ = words.projection;
        if (!files_word_) files_word_ = stored.projection;
        if (!files_word_) files_word_ = stored.by_names;
    }

    Shape make(std::vector<std::string>& notes) {
        if (stored_.face_count > 1) return separate_faces();

        std::optional<Projection> projection = users_word();
        if (projection && files_word_ && *projection != *files_word_) {
            notes.push_back(fmt::format("the file says that it is {}; read as {}, as asked",
                                        map_in_words(*files_word_), map_in_words(*projection)));
        }
        if (!projection) projection = files_word_;
        if (!projection) return guess(notes);
        return face_count(*projection) == 1 ? single_picture(*projection)
                                            : faces_in_picture(*projection);
    }

  private:
    [[noreturn]] void fail(Errc code, const std::string& what) const {
        throw Error(code, fmt::format("{}: {}", source_, what));
    }
    [[noreturn]] void fail_shape(const std::string& what) const {
        fail(Errc::cannot_read, fmt::format("{} x {} {}", width_, height_, what));
    }

    // The user's word for the projection, which a layout is too.
    [[nodiscard]] std::optional<Projection> users_word() const {
        if (options_.layout == Layout::automatic || options_.layout == Layout::single) {
            return options_.projection;
        }
        const Projection projection = arrangement(options_.layout).projection;
        if (options_.projection && *options_.projection != projection) {
            fail(Errc::usage,
                 fmt::format("the layout {} is one of {} maps, not of {}", name(options_.layout),
                             name(projection), map_in_words(*options_.projection)));
        }
        return projection;
    }

    [[nodiscard]] Shape separate_faces() const {
        const std::size_t count = stored_.face_count;
        if (count != 6 && count != 2) {
            fail(Errc::cannot_read, fmt::format("holds {} faces; expected 6 of a cube", count));
        }
        const Projection projection = count == 6 ? Projection::cube : Projection::dual_paraboloid;
        const auto contradicts = [&](const std::optional<Projection>& said) {
            return said && *said != projection;
        };
        const std::string what = fmt::format("{} faces are {}", count, map_in_words(projection));
        if (contradicts(users_word())) {
            fail(Errc::usage, fmt::format("{}, not {}", what, map_in_words(*users_word())));
        }
        if (contradicts(files_word_)) {
            fail(Errc::cannot_read,
                 fmt::format("{}, and the file says {}", what, map_in_words(*files_word_)));
        }
        if (options_.layout != Layout::automatic) {
            fail(Errc::usage, fmt::format("each face is a picture of its own, in no layout {}",
                                          name(options_.layout)));
        }
        if (options_.crop) fail(Errc::usage, "a circle can be cropped from one picture only");
        return {projection, Layout::automatic};
    }

    [[nodiscard]] Shape single_picture(Projection projection) const {
        if (options_.crop && projection != Projection::sphere &&
            projection != Projection::angular) {
            fail(Errc::usage, fmt::format("only sphere and angular maps are cropped to a circle, "
                                          "not {}",
                                          map_in_words(projection)));
        }
        if (width_ != std::int64_t{aspect(projection)} * height_) {
            fail_shape(fmt::format("is not {} ({})", map_in_words(projection),
                                   aspect(projection) == 2 ? "its width must be twice its height"
                                                           : "it must be square"));
        }
        return {projection, Layout::single};
    }

    [[nodiscard]] Shape faces_in_picture(Projection projection) const {
        if (options_.crop || options_.layout == Layout::single) {
            fail(Errc::usage, fmt::format("{} has {} faces, not {}", map_in_words(projection),
                                          face_count(projection),
                                          options_.crop ? "a circle to crop" : "a single one"));
        }
        Layout layout = options_.layout;
        if (layout == Layout::automatic && words_.layout && *words_.layout != Layout::single &&
            *words_.layout != Layout::automatic &&
            arrangement(*words_.layout).projection == projection) {
            layout = *words_.layout;
        }
        if (layout == Layout::automatic) {
            const std::optional<Layout> found = layout_by_shape(projection, width_, height_);
            if (found) return {projection, *found};
            fail_shape(fmt::format("is not {} in one picture ({})", map_in_words(projection),
                                   projection == Projection::cube
                                       ? "crosses are 4:3 and 3:4, strips 6:1 and 1:6"
                                       : "side by side they are 2:1"));
        }
        if (!fits(arrangement(layout), width_, height_)) {
            fail_shape(fmt::format("is not {}", shape_in_words(arrangement(layout))));
        }
        return {projection, layout};
    }

    // By shape alone.
    [[nodiscard]] Shape guess(std::vector<std::string>& notes) const {
        if (options_.crop) {
            fail(Errc::usage,
                 "a picture cropped to a circle may be a sphere map (a photograph of a "
                 "mirror ball) or an angular map; say which (--from)");
        }
        if (width_ == height_) {
            fail(Errc::usage,
                 fmt::format("{} x {} is square: it may be a sphere, angular, octahedral or "
                             "equal-area-octahedral map; say which (--from)",
                             width_, height_));
        }
        if (width_ == 2 * std::int64_t{height_}) {
            notes.push_back("taken for an equirect map, by its 2:1 shape");
            return {Projection::equirect, Layout::single};
        }
        const std::optional<Layout> layout = layout_by_shape(Projection::cube, width_, height_);
        if (!layout || options_.layout == Layout::single) {
            fail_shape(
                "is the shape of no environment map (equirect maps are 2:1, cube crosses "
                "4:3 and 3:4, cube strips 6:1 and 1:6, others square)");
        }
        notes.push_back(fmt::format("taken for a cube map in a {}, by its shape", name(*layout)));
        return {Projection::cube, *layout};
    }

    const std::string& source_;
    const StoredPictures& stored_;
    const MapWords& words_;
    const MapReadOptions& options_;
    int width_, height_;  // of the picture, or of what is cut from it
    std::optional<Projection> files_word_;
};

}  // namespace

Shape decide_shape(const std::string& source, const StoredPictures& stored, const MapWords& words,
                   const MapReadOptions& options, std::vector<std::string>& notes) {
    return Decision(source, stored, words, options).make(notes);
}

Axes decide_axes(Projection projection, const StoredPictures& stored, const MapWords& words,
                 const MapReadOptions& options) {
    if (!options.axes.empty()) return parse_axes(options.axes, projection);
    if (words.axes) return parse_axes(*words.axes, projection);
    // a format's axes are those of the projection that it says
    const bool formats_projection = !stored.projection || *stored.projection == projection;
    if (stored.axes && formats_projection) return *stored.axes;
    return default_axes(projection);
}

}  // namespace mirrorball::detail
