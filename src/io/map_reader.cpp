// read_map(): from a name to a map, in four steps.
//
//     gather   open the file or files; every face or picture that there is, as stored
//     decide   which projection, and how its faces lie (map_shape.h)
//     unfold   cut out the ball and the faces, as three channels
//     check    sizes of all levels, texels that cannot be light
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <mirrorball/builtin.h>
#include <mirrorball/error.h>

#include "ball_crop.h"
#include "core/part_of.h"
#include "face_pattern.h"
#include "face_words.h"
#include "layout.h"
#include "map_metadata.h"
#include "map_shape.h"
#include "repair.h"

namespace mirrorball {
namespace detail {
namespace {

constexpr std::string_view kBuiltinPrefix = "builtin:";

// Memory
// --------------------------------------------------------------------------------------------

std::uint64_t bytes_of(const FileContents& contents) {
    std::uint64_t bytes = 0;
    for (const std::vector<Image>& faces : contents.levels) {
        for (const Image& image : faces) bytes += image.values().size_bytes();
    }
    return bytes;
}

void check_memory(const std::string& source, std::uint64_t bytes, std::uint64_t limit) {
    if (bytes <= limit) return;
    const auto mib = [](std::uint64_t count) { return double(count) / (1024 * 1024); };
    throw Error(
        Errc::cannot_read,
        fmt::format("{}: reading it takes {:.1f} MiB of memory, and the limit is {:.1f} MiB",
                    source, mib(bytes), mib(limit)));
}

// Gather
// --------------------------------------------------------------------------------------------

// What was read, before anyone decides what it is.
struct Gathered {
    FileContents contents;
    std::optional<Projection> by_names;  // where the faces were files of their own
};

std::string size_in_words(const Image& image) {
    return fmt::format("{} x {}", image.width(), image.height());
}

// Appends one file's pictures to the faces gathered so far, which they must match.
void append_face(FileContents& faces, FileContents face, const std::filesystem::path& file,
                 const std::filesystem::path& first_file) {
    const auto fail = [&](const std::string& what) {
        throw Error(Errc::cannot_read, fmt::format("{}: {}", file.string(), what));
    };
    for (const std::vector<Image>& level : face.levels) {
        if (level.size() != 1) fail(fmt::format("holds {} faces, expected one", level.size()));
    }
    const Image& image = face.levels[0][0];
    if (image.width() != image.height()) {
        fail(fmt::format("{} is not square, as a face must be", size_in_words(image)));
    }
    for (std::string& note : face.notes) {
        faces.notes.push_back(fmt::format("{}: {}", file.filename().string(), note));
    }
    if (faces.levels.empty()) {
        face.notes = std::move(faces.notes);
        faces = std::move(face);
        return;
    }

    const Image& first = faces.levels[0][0];
    if (image.width() != first.width()) {
        fail(fmt::format("{}, and {} is {}; all faces must have one size", size_in_words(image),
                         first_file.string(), size_in_words(first)));
    }
    if (face.levels.size() != faces.levels.size()) {
        fail(fmt::format("has {} levels, and {} has {}", face.levels.size(), first_file.string(),
                         faces.levels.size()));
    }
    for (std::size_t level = 0; level < face.levels.size(); ++level) {
        faces.levels[level].push_back(std::move(face.levels[level][0]));
    }
}

Gathered gather_faces(const FaceFiles& found, const ReadOptions& options) {
    Gathered gathered{{}, found.projection};
    double begun = 0;
    const auto count = static_cast<double>(found.files.size());
    for (const std::filesystem::path& file : found.files) {
        ReadOptions left = options;
        left.progress = part_of(options.progress, begun / count, (begun + 1) / count);
        ++begun;
        left.memory_limit -= std::min(bytes_of(gathered.contents), left.memory_limit);
        append_face(gathered.contents, read_file(file, left), file, found.files.front());
    }
    if (!found.note.empty()) gathered.contents.notes.push_back(found.note);
    return gathered;
}

Gathered gather(const std::string& source, const MapReadOptions& options) {
    if (is_face_pattern(source)) {
        return gather_faces(find_face_files(source, options.projection), options);
    }
    std::error_code ignored;
    if (source.find(',') != std::string::npos && !std::filesystem::exists(source, ignored)) {
        return gather_faces(split_face_list(source), options);
    }
    return {read_file(source, options), std::nullopt};
}

// Unfold
// --------------------------------------------------------------------------------------------

bool has_alpha(const Image& image) {
    return image.channels() == 2 || image.channels() == 4;
}

bool is_opaque(const Image& image) {
    if (!has_alpha(image)) return true;
    const std::span<const float> values = image.values();
    for (std::size_t i = image.channels() - 1; i < values.size(); i += image.channels()) {
        if (values[i] != 1) return false;
    }
    return true;
}

// Grey becomes three equal channels; alpha is dropped.
Image to_rgb(Image image) {
    if (image.channels() == 3) return image;
    const bool grey = image.channels() < 3;
    Image rgb(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const float* texel = image.at(x, y);
            rgb.set_rgb(x, y, grey ? Vec3f(texel[0]) : Vec3f(texel[0], texel[1], texel[2]));
        }
    }
    return rgb;
}

// Bytes that unfold() holds at most, beside what was read.
std::uint64_t unfolding_bytes(const FileContents& contents, const Shape& shape,
                              const MapReadOptions& options) {
    const Image& base = contents.levels[0][0];
    const bool in_layout = shape.layout != Layout::automatic && shape.layout != Layout::single;
    if (!options.crop && !in_layout && base.channels() == 3) return 0;
    std::uint64_t texel_count = 0;
    for (const std::vector<Image>& faces : contents.levels) {
        for (const Image& image : faces) texel_count += image.texel_count();
    }
    return texel_count * 3 * sizeof(float);
}

// Takes the pictures apart as it goes, so that each is held once.
std::vector<Level> unfold(FileContents& contents, const Shape& shape,
                          const MapReadOptions& options) {
    const bool in_layout = shape.layout != Layout::automatic && shape.layout != Layout::single;
    std::vector<Level> levels(contents.levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) {
        for (Image& picture : contents.levels[i]) {
            if (options.crop) picture = crop_to_circle(picture, *options.crop);
            if (in_layout) {
                const Arrangement& a = arrangement(shape.layout);
                for (int face = 0; face < face_count(shape.projection); ++face) {
                    levels[i].faces.push_back(to_rgb(cut_face(picture, a, face)));
                }
            } else {
                levels[i].faces.push_back(to_rgb(std::move(picture)));
            }
            picture = Image();
        }
    }
    contents.levels.clear();
    return levels;
}

// Check
// ---------------------------------------------------------------------------------------------

// Before anything is cut: every level's pictures whole, and of the size that follows from level
// 0's.
void check_levels(const std::string& source, const FileContents& contents, const Shape& shape,
                  const MapReadOptions& options) {
    const auto fail = [&](const std::string& what) {
        throw Error(Errc::cannot_read, fmt::format("{}: {}", source, what));
    };
    if (options.crop) {
        const Image& picture = contents.levels[0][0];
        if (contents.levels.size() > 1) fail("a picture to crop must have one level");
        check_crop(source, picture.width(), picture.height(), *options.crop);
        return;
    }
    const bool in_layout = shape.layout != Layout::automatic && shape.layout != Layout::single;
    const int columns = in_layout ? arrangement(shape.layout).columns : aspect(shape.projection);
    const int rows = in_layout ? arrangement(shape.layout).rows : 1;
    const int base_size = contents.levels[0][0].height() / rows;
    for (std::size_t level = 0; level < contents.levels.size(); ++level) {
        const int size = std::max(1, base_size >> std::min<std::size_t>(level, 31));
        for (const Image& image : contents.levels[level]) {
            if (image.width() == columns * size && image.height() == rows * size) continue;
            fail(fmt::format("level {} is {}, expected {} x {}", level, size_in_words(image),
                             columns * size, rows * size));
        }
        if (contents.levels[level].size() != contents.levels[0].size()) {
            fail(fmt::format("level {} has {} faces, expected {}", level,
                             contents.levels[level].size(), contents.levels[0].size()));
        }
    }
}

void check_finite(const std::string& source, EnvironmentMap& map, int level,
                  const TexelFaults& faults, bool repairing, std::vector<std::string>& notes) {
    if (faults.non_finite_count == 0) return;
    const auto fail = [&](const std::string& what) {
        throw Error(Errc::cannot_read, fmt::format("{}: {}", source, what));
    };
    if (!repairing) fail(non_finite_in_words(map.projection, level, faults));
    if (repair(map.levels[level], map.projection) != faults.non_finite_count)
        fail(beyond_repair_in_words(map.projection, level, faults));
    notes.push_back(repaired_in_words(map.projection, level, faults));
}

void check_texels(const std::string& source, EnvironmentMap& map, bool repairing,
                  std::vector<std::string>& notes) {
    for (int level = 0; level < map.level_count(); ++level) {
        clear_unused_faults(map.levels[level], map.projection);
        const TexelFaults faults = find_faults(map.levels[level], map.projection);
        check_finite(source, map, level, faults, repairing, notes);
        if (faults.negative_count > 0) notes.push_back(negative_in_words(level, faults));
    }
}

// The whole
// -----------------------------------------------------------------------------------------

// Sizes at which built-in environments have about as many texels as a 1024 x 512 equirect.
int builtin_size(Projection projection) {
    switch (projection) {
        case Projection::equirect:
            return 1024;
        case Projection::cube:
            return 256;
        default:
            return 512;
    }
}

LoadedMap draw_builtin(const std::string& source, const MapReadOptions& options) {
    if (options.crop || options.layout != Layout::automatic) {
        throw Error(Errc::usage, fmt::format("{}: a built-in environment has no layout and no "
                                             "circle to crop",
                                             source));
    }
    const Projection projection = options.projection.value_or(Projection::equirect);
    const int size = builtin_size(projection);
    check_memory(source, environment_map_bytes(projection, size), options.memory_limit);
    const Axes axes =
        options.axes.empty() ? default_axes(projection) : parse_axes(options.axes, projection);

    LoadedMap loaded;
    loaded.map = make_builtin(source.substr(kBuiltinPrefix.size()), projection, size, axes,
                              options.progress);
    loaded.format = "built-in";
    loaded.stored = TexelFormat::rgba32f;
    return loaded;
}

LoadedMap load(const std::string& source, const MapReadOptions& options) {
    Gathered gathered = gather(source, options);
    FileContents& contents = gathered.contents;
    const MapWords words = parse_words(contents.metadata, source);

    LoadedMap loaded;
    loaded.format = contents.format;
    loaded.stored = contents.stored;
    loaded.metadata = contents.metadata;
    loaded.notes = contents.notes;

    const Image& base = contents.levels[0][0];
    const StoredPictures stored{contents.levels[0].size(), base.width(),  base.height(),
                                contents.projection,       contents.axes, gathered.by_names};
    const Shape shape = decide_shape(source, stored, words, options, loaded.notes);
    check_levels(source, contents, shape, options);
    check_memory(source, bytes_of(contents) + unfolding_bytes(contents, shape, options),
                 options.memory_limit);
    loaded.map.projection = shape.projection;
    loaded.map.axes = decide_axes(shape.projection, stored, words, options);

    const bool opaque = std::all_of(contents.levels.begin(), contents.levels.end(),
                                    [](const std::vector<Image>& faces) {
                                        return std::all_of(faces.begin(), faces.end(), is_opaque);
                                    });
    if (!opaque) loaded.notes.emplace_back(kAlphaDropped);

    loaded.map.levels = unfold(contents, shape, options);
    apply_lobes(words, loaded.map, source);
    check_texels(source, loaded.map, options.repair, loaded.notes);
    return loaded;
}

}  // namespace
}  // namespace detail

LoadedMap read_map(const std::string& source, const MapReadOptions& options) {
    return source.starts_with(detail::kBuiltinPrefix) ? detail::draw_builtin(source, options)
                                                      : detail::load(source, options);
}

}  // namespace mirrorball
