// write_map(): a map as the formats take it - one picture, six faces, or a file for each face.
//
// A face that the texel format can hold is written from where it is. Any other is copied and
// clamped to what the format holds, so that the caller's map stays as it is, and what a clamp cuts
// off is known where its solid angle is.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <mirrorball/error.h>

#include "all_within.h"
#include "codec.h"
#include "core/parallel.h"
#include "face_pattern.h"
#include "face_words.h"
#include "layout.h"
#include "map_metadata.h"
#include "texel_use.h"

namespace mirrorball {
namespace detail {
namespace {

// Gives faces within the range of a texel format, and keeps account of what it cuts off.
class FaceEncoder {
  public:
    FaceEncoder(const EnvironmentMap& map, TexelFormat format, std::string target)
        : map_(map),
          format_(format),
          target_(std::move(target)),
          lowest_(lowest_value(format)),
          largest_(std::min(
              {largest_value(format, 0), largest_value(format, 1), largest_value(format, 2)})),
          lost_flux_(map.levels.size(), Vec3d(0, 0, 0)) {}

    /// The face as the format holds it: the map's own, or a copy that lives as long as this. Unused
    /// texels are 0.
    const Image& encode(int level, int face) {
        const Image& original = map_.levels[level].faces[face];
        const std::vector<int> rows = rows_beyond_range(original);
        const bool has_unused = has_unused_texels(map_.projection);
        if (rows.empty() && !has_unused) return original;
        Image& image = copies_.emplace_back(original);
        if (has_unused) clear_unused(image);
        for (const int y : rows) clamp_row(image, level, face, y);
        return image;
    }

    /// All faces of a level in one picture.
    const Image& pasted(int level, const Arrangement& a) {
        const int size = map_.height(level);
        Image picture(a.columns * size, a.rows * size, 3);
        for (int face = 0; face < face_count(map_.projection); ++face)
            paste_face(picture, encode(level, face), a, face);
        return copies_.emplace_back(std::move(picture));
    }

    /// The flux is that of the level that loses most: each level is a whole sphere.
    [[nodiscard]] WriteReport report() const {
        WriteReport report;
        report.clipped_texel_count = clipped_texel_count_;
        const auto size = [](const Vec3d& flux) {
            return std::abs(flux.x) + std::abs(flux.y) + std::abs(flux.z);
        };
        for (const Vec3d& flux : lost_flux_) {
            if (size(flux) > size(report.lost_flux)) report.lost_flux = flux;
        }
        return report;
    }

  private:
    // From the top.
    [[nodiscard]] std::vector<int> rows_beyond_range(const Image& image) const {
        std::vector<unsigned char> is_beyond(image.height());
        parallel_for(image.height(), [&](std::int64_t y) {
            is_beyond[y] = !all_within(image.row(static_cast<int>(y)), lowest_, largest_);
        });
        std::vector<int> rows;
        for (int y = 0; y < image.height(); ++y)
            if (is_beyond[y] != 0) rows.push_back(y);
        return rows;
    }

    // Used parts are round: the unused texels of a row are at its two ends, equally many.
    void clear_unused(Image& image) const {
        const int width = image.width(), height = image.height();
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width / 2; ++x) {
                if (texel_solid_angle(map_.projection, width, height, x, y) > 0) break;
                image.set_rgb(x, y, Vec3f(0, 0, 0));
                image.set_rgb(width - 1 - x, y, Vec3f(0, 0, 0));
            }
        }
    }

    void clamp_row(Image& image, int level, int face, int y) {
        for (int x = 0; x < image.width(); ++x) {
            const Vec3f before = image.rgb(x, y);
            if (std::isnan(before.x) || std::isnan(before.y) || std::isnan(before.z)) {
                throw Error(Errc::cannot_write,
                            fmt::format("{}: {} is not a number (NaN)", target_,
                                        texel_in_words(map_.projection, level, face, x, y)));
            }
            if (!clamp_texel(std::span(image.at(x, y), 3), format_)) continue;
            ++clipped_texel_count_;
            const double solid_angle =
                texel_solid_angle(map_.projection, image.width(), image.height(), x, y);
            lost_flux_[level] += (Vec3d(before) - Vec3d(image.rgb(x, y))) * solid_angle;
        }
    }

    const EnvironmentMap& map_;
    TexelFormat format_;
    std::string target_;
    float lowest_, largest_;  // that all three channels hold
    std::int64_t clipped_texel_count_ = 0;
    std::vector<Vec3d> lost_flux_;
    std::deque<Image> copies_;
};

// The layout that a request comes down to; `automatic` where the faces stay six.
Layout choose_layout(const Codec& codec, Projection projection, Layout wanted,
                     const std::string& target) {
    const bool one_face = face_count(projection) == 1;
    if (wanted == Layout::automatic) {
        if (one_face) return Layout::single;
        if (projection == Projection::dual_paraboloid) return Layout::side_by_side;
        return codec.holds_cubes ? Layout::automatic : Layout::horizontal_cross;
    }
    if (one_face != (wanted == Layout::single) ||
        (!one_face && arrangement(wanted).projection != projection)) {
        throw Error(Errc::usage, fmt::format("{}: the layout {} does not fit {}", target,
                                             name(wanted), map_in_words(projection)));
    }
    return wanted;
}

// A format halves the whole picture from level to level, which is not always what became of a face.
void check_halving(const ContentsView& contents, const std::string& target) {
    const Image& base = contents.levels[0][0];
    for (std::size_t level = 1; level < contents.levels.size(); ++level) {
        const Image& image = contents.levels[level][0];
        const int width = std::max(1, base.width() >> level);
        const int height = std::max(1, base.height() >> level);
        if (image.width() == width && image.height() == height) continue;
        throw Error(Errc::usage,
                    fmt::format("{}: level {} is {} x {} in this layout, and the format wants "
                                "{} x {}; only faces of a power of two halve evenly",
                                target, level, image.width(), image.height(), width, height));
    }
}

ContentsView contents_for(const EnvironmentMap& map, Layout layout, const Metadata& metadata) {
    ContentsView contents;
    contents.metadata = describe(map, layout, metadata);
    return contents;
}

// Everything in one file, as faces of their own or as a picture.
ContentsView whole_map(FaceEncoder& encoder, ContentsView contents, const EnvironmentMap& map,
                       Layout layout, const std::string& target) {
    const bool in_layout = layout != Layout::automatic && layout != Layout::single;
    for (int level = 0; level < map.level_count(); ++level) {
        std::vector<ContentsView::Picture>& images = contents.levels.emplace_back();
        if (in_layout) {
            images.emplace_back(encoder.pasted(level, arrangement(layout)));
        } else {
            for (int face = 0; face < face_count(map.projection); ++face) {
                images.emplace_back(encoder.encode(level, face));
            }
        }
    }
    if (in_layout) {
        check_halving(contents, target);
    } else {
        contents.projection = map.projection;
        contents.axes = map.axes;
    }
    return contents;
}

// Files that appear together: all are written before the first takes its name.
class FileSet {
  public:
    void write(const std::filesystem::path& path, const Codec& codec, const ContentsView& contents,
               const WriteOptions& options) {
        files_.push_back(std::make_unique<OutputFile>(path));
        codec.write(*files_.back(), contents, options);
    }
    std::uint64_t commit() {
        std::uint64_t byte_count = 0;
        for (const std::unique_ptr<OutputFile>& file : files_) {
            file->commit();
            byte_count += file->size();
        }
        return byte_count;
    }

  private:
    std::vector<std::unique_ptr<OutputFile>> files_;
};

void write_faces(FileSet& files, FaceEncoder& encoder, const ContentsView& frame,
                 const EnvironmentMap& map, const std::vector<std::filesystem::path>& paths,
                 const Codec& codec, const WriteOptions& options) {
    for (std::size_t face = 0; face < paths.size(); ++face) {
        ContentsView contents = frame;
        for (int level = 0; level < map.level_count(); ++level) {
            contents.levels.emplace_back().emplace_back(encoder.encode(level, int(face)));
        }
        files.write(paths[face], codec, contents, options);
    }
}

}  // namespace
}  // namespace detail

WriteReport write_map(const std::string& target, const EnvironmentMap& map,
                      const MapWriteOptions& options) {
    using namespace detail;
    assert(!map.levels.empty());

    const bool file_per_face = is_face_pattern(target);
    const Codec& codec = codec_for_name(target);
    WriteOptions chosen = options;
    chosen.format = choose_texel_format(codec, options.format, target);
    check_level_count(codec, map.level_count(), target);

    FaceEncoder encoder(map, chosen.format, target);
    FileSet files;
    if (file_per_face) {
        const auto paths = face_targets(target, map.projection);
        if (options.layout != Layout::automatic) {
            throw Error(Errc::usage, fmt::format("{}: a file for each face has no layout {}",
                                                 target, name(options.layout)));
        }
        write_faces(files, encoder, contents_for(map, Layout::automatic, options.metadata), map,
                    paths, codec, chosen);
    } else {
        const Layout layout = choose_layout(codec, map.projection, options.layout, target);
        files.write(
            target, codec,
            whole_map(encoder, contents_for(map, layout, options.metadata), map, layout, target),
            chosen);
    }

    WriteReport report = encoder.report();
    report.byte_count = files.commit();
    return report;
}

}  // namespace mirrorball
