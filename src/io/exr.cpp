// OpenEXR, by its library: half and float pictures, cubes and levels in one file.
//
// A picture is written as it is, in our placement. A cube, and an equirect in the frame that
// OpenEXR has for it, are written as OpenEXR's environment maps: with the attribute `envmap`, and
// re-sampled to its grids (edge_grid.h). A file with that attribute comes out in our conventions.
// Its cube is a strip, +X on top, seen from inside a right-handed world. Ours negates that world's
// z, so +Z and -Z change places and every picture stays as it is.
//
// Levels are OpenEXR's mip levels. Those always go down to one texel; where the map has fewer, the
// rest is filled with means and an attribute says how many count.
#include <algorithm>
#include <climits>
#include <cmath>
#include <new>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledInputPart.h>
#include <ImfTiledOutputFile.h>
#include <half.h>

#include <mirrorball/error.h>

#include "codec.h"
#include "core/parallel.h"
#include "edge_grid.h"
#include "exr_names.h"
#include "exr_picture.h"
#include "exr_words.h"
#include "packed.h"
#include "row_source.h"

namespace mirrorball::detail {
namespace {

using Imath::Box2i;
using Imath::V2i;

constexpr std::array<unsigned char, 4> kMagic = {0x76, 0x2f, 0x31, 0x01};

class Input : public Imf::IStream {
  public:
    explicit Input(InputFile& file) : IStream(file.name().c_str()), file_(file) {}

    bool read(char bytes[], int count) override {
        if (static_cast<std::uint64_t>(count) > file_.remaining())
            throw Iex::InputExc(fmt::format("the file ends at byte {}", file_.size()));
        file_.read(std::as_writable_bytes(std::span(bytes, static_cast<std::size_t>(count))));
        return file_.remaining() > 0;
    }
    std::uint64_t tellg() override { return file_.position(); }
    void seekg(std::uint64_t position) override {
        if (position > file_.size())
            throw Iex::InputExc(fmt::format("byte {} is past the end of the file", position));
        file_.seek(position);
    }

  private:
    InputFile& file_;
};

class Output : public Imf::OStream {
  public:
    explicit Output(OutputFile& file) : OStream(file.name().c_str()), file_(file) {}

    void write(const char bytes[], int count) override {
        file_.write(std::as_bytes(std::span(bytes, static_cast<std::size_t>(count))));
    }
    std::uint64_t tellp() override { return file_.position(); }
    void seekp(std::uint64_t position) override { file_.seek(position); }

  private:
    OutputFile& file_;
};

bool recognises(std::span<const std::byte> head) {
    return head.size() >= kMagic.size() &&
           std::equal(kMagic.begin(), kMagic.end(), head.begin(),
                      [](unsigned char a, std::byte b) { return std::byte{a} == b; });
}

// Reading -----------------------------------------------------------------------------------------

// The channels that make a picture: by their plain names or those of one layer ("left.R").
struct Picture {
    int part = 0;
    std::vector<std::string> channels;  // R G B, R G B A, Y, or Y A
    bool is_half = true;
};

std::vector<std::string> channels_of(const Imf::Header& header) {
    std::vector<std::string> names;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
        names.emplace_back(i.name());
    return names;
}

std::optional<Picture> find_picture(const Imf::Header& header, int part) {
    if (header.hasType() && Imf::isDeepData(header.type())) return std::nullopt;
    const Imf::ChannelList& list = header.channels();
    auto names = picture_channels(channels_of(header));
    if (!names) return std::nullopt;
    Picture picture{part, std::move(*names)};
    for (const std::string& name : picture.channels)
        picture.is_half &= list.findChannel(name.c_str())->type == Imf::HALF;
    return picture;
}

Picture choose_picture(const InputFile& file, const Imf::MultiPartInputFile& exr,
                       FileContents& contents) {
    for (int part = 0; part < exr.parts(); ++part)
        if (auto picture = find_picture(exr.header(part), part)) {
            note_choice(exr.parts(), part, picture->channels, contents.notes);
            return *picture;
        }
    const Imf::Header& first = exr.header(0);
    if (first.hasType() && Imf::isDeepData(first.type())) file.fail(kDeepPixels);
    file.fail(no_picture_among(channels_of(first)));
}

// The most pixel bytes that one byte of a chunk can stand for, so that a claim can be held against
// the file's length:
//   RLE    two bytes for a run of 128
//   ZIP    deflate's limit, 1032; PXR24 also drops every fourth byte
//   PIZ    ten bits, two codes and a count of 256, for 256 halves
//   B44A   three bytes for 16 halves
//   DWA    deflated means of 64 halves, or a deflated RLE
double largest_ratio(Imf::Compression compression) {
    switch (compression) {
        case Imf::NO_COMPRESSION:
            return 1;
        case Imf::RLE_COMPRESSION:
            return 64;
        case Imf::ZIPS_COMPRESSION:
        case Imf::ZIP_COMPRESSION:
            return 1032;
        case Imf::PXR24_COMPRESSION:
            return 1032 * 4.0 / 3;
        case Imf::PIZ_COMPRESSION:
            return 512;
        case Imf::B44_COMPRESSION:
        case Imf::B44A_COMPRESSION:
            return 16;
        default:
            return 64 * 1032;
    }
}

int lines_per_chunk(Imf::Compression compression) {
    switch (compression) {
        case Imf::ZIP_COMPRESSION:
        case Imf::PXR24_COMPRESSION:
            return 16;
        case Imf::PIZ_COMPRESSION:
        case Imf::B44_COMPRESSION:
        case Imf::B44A_COMPRESSION:
        case Imf::DWAA_COMPRESSION:
            return 32;
        case Imf::DWAB_COMPRESSION:
            return 256;
        default:
            return 1;
    }
}

double texel_bytes(const Imf::ChannelList& channels) {
    double bytes = 0;
    for (auto i = channels.begin(); i != channels.end(); ++i)
        bytes += i.channel().type == Imf::HALF ? 2 : 4;
    return bytes;
}

bool has_levels(const Imf::Header& header) {
    return header.hasTileDescription() && header.tileDescription().mode == Imf::MIPMAP_LEVELS;
}

void check_header(InputFile& file, const Imf::Header& header, const Picture& picture,
                  const ReadOptions& options) {
    for (const std::string& name : picture.channels) {
        const Imf::Channel& channel = *header.channels().findChannel(name.c_str());
        if (channel.xSampling != 1 || channel.ySampling != 1)
            file.fail(sub_sampled(name, channel.xSampling, channel.ySampling));
    }
    if (header.hasTileDescription() && header.tileDescription().mode == Imf::RIPMAP_LEVELS)
        file.fail(kRipmapLevels);

    const std::int64_t width = width_of(header.dataWindow()),
                       height = height_of(header.dataWindow());
    const double pixels = double(width) * double(height);
    const double bytes = pixels * texel_bytes(header.channels());
    const double needed = bytes / largest_ratio(header.compression());
    file.seek(0);
    check_claim(file, width, height, static_cast<int>(picture.channels.size()),
                image_count_bound(1, has_levels(header) ? 2 : 1),
                static_cast<std::uint64_t>(std::min(needed, 1e18)), options);

    // The library sets aside a whole chunk, be the picture as small as it may.
    double chunk_texels = double(width) * lines_per_chunk(header.compression());
    if (header.hasTileDescription()) {
        const Imf::TileDescription& tiles = header.tileDescription();
        chunk_texels = double(tiles.xSize) * tiles.ySize;
        if (chunk_texels > std::max(4 * pixels, double(1 << 22)))
            file.fail(tiles_too_large(tiles.xSize, tiles.ySize, width, height));
    }
    if (chunk_texels * texel_bytes(header.channels()) > INT_MAX)
        file.fail(fmt::format("is stored in pieces of {:.0f} texels, more than can be read at once",
                              chunk_texels));
}

// Float slices over texels of which the first is at `origin`.
Imf::FrameBuffer frame_buffer(float* values, int width, const Picture& picture, const V2i& origin,
                              int height) {
    Imf::FrameBuffer buffer;
    const std::size_t texel = sizeof(float) * picture.channels.size();
    for (std::size_t c = 0; c < picture.channels.size(); ++c)
        buffer.insert(picture.channels[c],
                      Imf::Slice::Make(Imf::FLOAT, values + c, origin, width, height, texel,
                                       texel * static_cast<std::size_t>(width)));
    return buffer;
}

Imf::FrameBuffer frame_buffer(Image& image, const Picture& picture, const Box2i& window) {
    return frame_buffer(image.values().data(), image.width(), picture, window.min, image.height());
}

// A part of a file opened several times over, to be decoded by all threads: OpenEXR's own threads
// would be shared with whoever else uses the library in this process. Which of them decodes what
// makes no difference to what comes out.
class PartReaders {
  public:
    static constexpr int kCount = 4;

    PartReaders(const InputFile& file, int part) {
        for (auto& reader : readers_) reader = std::make_unique<Reader>(file, part);
    }

    /// Calls f(part, first, last) for ranges of rows that make up [begin, begin + count), with
    /// boundaries between pieces of `piece` rows.
    template <class F>
    void for_each_range(int begin, int count, int piece, F&& f) {
        const int first_piece = begin / piece, last_piece = (begin + count - 1) / piece + 1;
        const int pieces = last_piece - first_piece;
        parallel_for(kCount, [&](std::int64_t i) {
            const auto boundary = [&](std::int64_t at) {
                const std::int64_t row = (first_piece + pieces * at / kCount) * piece;
                return static_cast<int>(
                    std::clamp<std::int64_t>(row, begin, std::int64_t{begin} + count));
            };
            const int first = boundary(i), last = boundary(i + 1);
            if (first < last) f(readers_[i]->part, first, last);
        });
    }

  private:
    struct Reader {
        Reader(const InputFile& original, int index)
            : file(original.another()),
              stream(*file),
              exr(stream, 0, false),
              part(exr, index) {}
        std::unique_ptr<InputFile> file;
        Input stream;
        Imf::MultiPartInputFile exr;
        Imf::InputPart part;
    };
    std::array<std::unique_ptr<Reader>, kCount> readers_;
};

Image make_image(const Box2i& window, const Picture& picture) {
    return Image(static_cast<int>(width_of(window)), static_cast<int>(height_of(window)),
                 static_cast<int>(picture.channels.size()));
}

// That each reader decodes until the progress is told.
constexpr int kPiecesBetweenWords = 4;

// The levels' data windows, as pictures.
std::vector<Image> read_levels(InputFile& file, Imf::MultiPartInputFile& exr,
                               const Picture& picture) {
    const Imf::Header& header = exr.header(picture.part);
    if (!exr.partComplete(picture.part)) file.fail(kNeverWritten);
    std::vector<Image> levels;
    if (!has_levels(header)) {
        const Box2i window = header.dataWindow();
        Image& image = levels.emplace_back(make_image(window, picture));
        PartReaders readers(file, picture.part);
        const int piece = lines_per_chunk(header.compression());
        const int step = kPiecesBetweenWords * PartReaders::kCount * piece;
        for (int begin = 0; begin < image.height(); begin += step) {
            const int count = std::min(step, image.height() - begin);
            readers.for_each_range(
                begin, count, piece, [&](Imf::InputPart& part, int first, int last) {
                    part.setFrameBuffer(frame_buffer(image, picture, window));
                    part.readPixels(window.min.y + first, window.min.y + last - 1);
                });
            file.tell(static_cast<double>(begin + count) / image.height());
        }
        return levels;
    }
    Imf::TiledInputPart part(exr, picture.part);
    // Also those that do not count, to find a file that was cut short.
    for (int level = 0; level < part.numLevels(); ++level) {
        const Box2i window = part.dataWindowForLevel(level);
        Image& image = levels.emplace_back(make_image(window, picture));
        part.setFrameBuffer(frame_buffer(image, picture, window));
        part.readTiles(0, part.numXTiles(level) - 1, 0, part.numYTiles(level) - 1, level);
        file.tell(1 - std::pow(0.25, level + 1));
    }
    return levels;
}

Image paste_strip(const std::vector<Image>& faces) {
    const int n = faces.front().width();
    Image strip(n, 6 * n, faces.front().channels());
    constexpr int kOrder[6] = {0, 1, 2, 3, 5, 4};
    for (int place = 0; place < 6; ++place)
        for (int y = 0; y < n; ++y) {
            const std::span<const float> row = faces[kOrder[place]].row(y);
            std::copy(row.begin(), row.end(), strip.row(place * n + y).begin());
        }
    return strip;
}

void read_attributes(const Imf::Header& header, FileContents& contents) {
    for (auto i = header.begin(); i != header.end(); ++i) {
        const std::string name = i.name();
        if (name == "type" || name == "name") continue;  // of the part, not of the picture
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()))
            contents.metadata[name] = text->value();
    }
    if (!Imf::hasChromaticities(header)) return;
    const Imf::Chromaticities found = Imf::chromaticities(header), rec709;
    constexpr float kTolerance = 2e-3f;  // primaries are quoted with three digits
    const auto differ = [](const Imath::V2f& a, const Imath::V2f& b) {
        return !a.equalWithAbsError(b, kTolerance);
    };
    if (differ(found.red, rec709.red) || differ(found.green, rec709.green) ||
        differ(found.blue, rec709.blue) || differ(found.white, rec709.white))
        contents.notes.push_back(fmt::format(
            "has other primaries than Rec. 709 (red {:.4g} {:.4g}, green {:.4g} {:.4g}, "
            "blue {:.4g} {:.4g}, white {:.4g} {:.4g}); its values are kept as they are",
            found.red.x, found.red.y, found.green.x, found.green.y, found.blue.x, found.blue.y,
            found.white.x, found.white.y));
}

FileContents read_picture(InputFile& file, const ReadOptions& options) {
    file.seek(0);
    Input stream(file);
    // No threads of the library's own; and no guess at the table of a file that was cut short.
    Imf::MultiPartInputFile exr(stream, 0, false);

    FileContents contents;
    contents.format = kExr.name;
    const Picture picture = choose_picture(file, exr, contents);
    const Imf::Header& header = exr.header(picture.part);
    check_header(file, header, picture, options);
    read_attributes(header, contents);
    contents.stored = picture.is_half ? TexelFormat::rgba16f : TexelFormat::rgba32f;

    ExrPictureWords words{header.dataWindow(), header.displayWindow(), {}, {}};
    if (Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_LATLONG)
        words.environment = Projection::equirect;
    if (Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE)
        words.environment = Projection::cube;
    if (const auto* count = header.findTypedAttribute<Imf::IntAttribute>(kLevelCountAttribute))
        words.level_count = count->value();
    take_exr_levels(file, read_levels(file, exr, picture), words, options, contents);
    drop_opaque_alpha(contents);
    return contents;
}

// What the library throws, as what we throw.
template <class F>
auto in_our_words(const InputFile& file, F&& f) {
    try {
        return f();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        file.fail(fmt::format("is no OpenEXR file that can be read ({})", error.what()));
    }
}

FileContents read(InputFile& file, const ReadOptions& options) {
    return in_our_words(file, [&] { return read_picture(file, options); });
}

// Row by row --------------------------------------------------------------------------------------

class ExrRows : public RowSource {
  public:
    ExrRows(InputFile& file, const Imf::MultiPartInputFile& exr, Picture picture,
            FileContents contents)
        : file_(file),
          picture_(std::move(picture)),
          window_(exr.header(picture_.part).dataWindow()) {
        const Imf::Header& part = exr.header(picture_.part);
        header.width = static_cast<int>(width_of(window_));
        header.height = static_cast<int>(height_of(window_));
        header.channels = static_cast<int>(picture_.channels.size());
        header.stored = contents.stored;
        header.metadata = std::move(contents.metadata);
        header.notes = std::move(contents.notes);
        piece_rows_ = part.hasTileDescription() ? static_cast<int>(part.tileDescription().ySize)
                                                : lines_per_chunk(part.compression());
        piece_rows_ = std::min(piece_rows_, header.height);
        texel_bytes_ = texel_bytes(part.channels());
    }

    void read(int count, std::span<float> values) override {
        in_our_words(file_, [&] {
            read_lines(count, values);
            return 0;
        });
        done_ += count;
    }
    [[nodiscard]] int rows_at_once() const override {
        constexpr int kEnough = 64;
        return std::max(kEnough / piece_rows_, PartReaders::kCount) * piece_rows_;
    }
    // A reader holds a piece as it is stored, the same unpacked, and the table of all pieces.
    [[nodiscard]] std::uint64_t bytes_held() const override {
        const double piece = double(header.width) * piece_rows_ * texel_bytes_;
        const double table = 8.0 * header.height;
        return static_cast<std::uint64_t>(PartReaders::kCount * (3 * piece + table));
    }

  private:
    void read_lines(int count, std::span<float> values) {
        if (!readers_) readers_.emplace(file_, picture_.part);
        readers_->for_each_range(
            done_, count, piece_rows_, [&](Imf::InputPart& part, int first, int last) {
                const Imf::FrameBuffer buffer = frame_buffer(
                    values.data() + static_cast<std::size_t>(first - done_) * values.size() / count,
                    header.width, picture_, {window_.min.x, window_.min.y + first}, last - first);
                part.setFrameBuffer(buffer);
                part.readPixels(window_.min.y + first, window_.min.y + last - 1);
            });
    }

    InputFile& file_;
    Picture picture_;
    Box2i window_;
    std::optional<PartReaders> readers_;  // none before they are needed
    int piece_rows_ = 1, done_ = 0;
    double texel_bytes_ = 0;
};

std::unique_ptr<RowSource> open_rows(InputFile& file, const ReadOptions& options,
                                     std::string& obstacle) {
    return in_our_words(file, [&]() -> std::unique_ptr<RowSource> {
        file.seek(0);
        Input stream(file);
        Imf::MultiPartInputFile exr(stream, 0, false);
        FileContents contents;
        Picture picture = choose_picture(file, exr, contents);
        const Imf::Header& header = exr.header(picture.part);
        if (Imf::hasEnvmap(header))
            obstacle = "its envmap attribute says that it has its samples on texels' edges";
        else if (header.dataWindow() != header.displayWindow())
            obstacle = "its data window is not its display window";
        if (!obstacle.empty()) return nullptr;

        ReadOptions unlimited = options;
        unlimited.memory_limit = kUnlimitedMemory;
        check_header(file, header, picture, unlimited);
        if (!exr.partComplete(picture.part)) file.fail(kNeverWritten);
        read_attributes(header, contents);
        contents.stored = picture.is_half ? TexelFormat::rgba16f : TexelFormat::rgba32f;
        return std::make_unique<ExrRows>(file, exr, std::move(picture), std::move(contents));
    });
}

// Writing -----------------------------------------------------------------------------------------

// Each texel the mean of the four under it, fewer at an odd end.
Image halved(const Image& image) {
    Image result(level_size(image.width(), 1), level_size(image.height(), 1), image.channels());
    for (int y = 0; y < result.height(); ++y)
        for (int x = 0; x < result.width(); ++x) {
            const int x1 = std::min(2 * x + 1, image.width() - 1);
            const int y1 = std::min(2 * y + 1, image.height() - 1);
            for (int c = 0; c < image.channels(); ++c)
                result.at(x, y)[c] = 0.25f * (image.at(2 * x, 2 * y)[c] + image.at(x1, 2 * y)[c] +
                                              image.at(2 * x, y1)[c] + image.at(x1, y1)[c]);
        }
    return result;
}

// What lies in the file, level by level, and which kind of environment it is.
struct Pictures {
    std::vector<Image> levels;
    std::optional<Imf::Envmap> environment;
};

bool is_latlong(const ContentsView& contents) {
    const Image& base = contents.levels.front().front();
    return contents.projection == Projection::equirect && contents.axes == kLatLongAxes &&
           base.height() >= 2 && base.width() == 2 * base.height();
}

Pictures arrange(const OutputFile& file, const ContentsView& contents) {
    const std::size_t face_count = contents.levels.front().size();
    if (face_count != 1 && face_count != 6)
        file.fail(fmt::format("{} faces; OpenEXR files hold one picture or a cube", face_count));
    require_halved_levels(file, contents);
    Pictures result;
    if (face_count == 6)
        result.environment = Imf::ENVMAP_CUBE;
    else if (is_latlong(contents))
        result.environment = Imf::ENVMAP_LATLONG;
    for (const std::vector<ContentsView::Picture>& faces : contents.levels)
        if (result.environment == Imf::ENVMAP_CUBE)
            result.levels.push_back(paste_strip(cube_to_edge_grid({faces.begin(), faces.end()})));
        else if (result.environment == Imf::ENVMAP_LATLONG)
            result.levels.push_back(equirect_to_edge_grid(faces.front()));
        else
            result.levels.push_back(faces.front());
    return result;
}

// The sizes of OpenEXR's levels follow from the strip's, which only halves with its faces as long
// as they are even.
void require_exr_levels(const OutputFile& file, const std::vector<Image>& levels) {
    const Image& base = levels.front();
    for (int level = 0; level < static_cast<int>(levels.size()); ++level)
        if (levels[level].width() != level_size(base.width(), level) ||
            levels[level].height() != level_size(base.height(), level))
            file.fail(
                fmt::format("OpenEXR can hold level {} of a cube only if its face size ({}) can "
                            "be halved that often; KTX2 (.ktx2) can hold it",
                            level, base.width()));
}

std::vector<std::string> channel_names(int channels) {
    switch (channels) {
        case 1:
            return {"Y"};
        case 2:
            return {"Y", "A"};
        case 3:
            return {"R", "G", "B"};
        default:
            return {"R", "G", "B", "A"};
    }
}

Imf::Header make_header(const ContentsView& contents, const Pictures& pictures,
                        const WriteOptions& options) {
    const Image& base = pictures.levels.front();
    Imf::Header header(base.width(), base.height());
    header.compression() =
        options.compress.value_or(true) ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION;
    const Imf::PixelType type = options.format == TexelFormat::rgba32f ? Imf::FLOAT : Imf::HALF;
    for (const std::string& name : channel_names(base.channels()))
        header.channels().insert(name, Imf::Channel(type));
    Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709's
    if (pictures.environment) Imf::addEnvmap(header, *pictures.environment);
    if (pictures.levels.size() > 1) {
        header.setTileDescription(
            Imf::TileDescription(64, 64, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
        header.insert(kLevelCountAttribute,
                      Imf::IntAttribute(static_cast<int>(pictures.levels.size())));
    }
    for (const auto& [key, value] : contents.metadata)
        // What the library or we have said above is not for the metadata to say otherwise.
        if (!key.empty() && header.find(key) == header.end())
            header.insert(key, Imf::StringAttribute(value));
    return header;
}

// A picture's numbers in the type of the file, and the slices over them.
class PixelsToWrite {
  public:
    PixelsToWrite(const Image& image, Imf::PixelType type) {
        const std::size_t count = image.values().size();
        const void* data = image.values().data();
        std::size_t number = sizeof(float);
        if (type == Imf::HALF) {
            halves_.resize(count);
            std::transform(image.values().begin(), image.values().end(), halves_.begin(),
                           [](float value) { return Imath::half(value); });
            data = halves_.data();
            number = sizeof(Imath::half);
        }
        const std::vector<std::string> names = channel_names(image.channels());
        const std::size_t texel = number * names.size();
        for (std::size_t c = 0; c < names.size(); ++c)
            buffer_.insert(
                names[c],
                Imf::Slice::Make(type, static_cast<const char*>(data) + c * number, V2i(0),
                                 image.width(), image.height(), texel, texel * image.width()));
    }
    [[nodiscard]] const Imf::FrameBuffer& buffer() const { return buffer_; }

  private:
    std::vector<Imath::half> halves_;
    Imf::FrameBuffer buffer_;
};

void write_levels(Output& stream, const Imf::Header& header, const std::vector<Image>& levels,
                  Imf::PixelType type) {
    if (levels.size() == 1) {
        Imf::OutputFile exr(stream, header, 0);
        const PixelsToWrite pixels(levels.front(), type);
        exr.setFrameBuffer(pixels.buffer());
        exr.writePixels(levels.front().height());
        return;
    }
    Imf::TiledOutputFile exr(stream, header, 0);
    Image filling;
    for (int level = 0; level < exr.numLevels(); ++level) {
        const bool is_ours = level < static_cast<int>(levels.size());
        if (!is_ours) filling = halved(filling.empty() ? levels.back() : filling);
        const PixelsToWrite pixels(is_ours ? levels[level] : filling, type);
        exr.setFrameBuffer(pixels.buffer());
        exr.writeTiles(0, exr.numXTiles(level) - 1, 0, exr.numYTiles(level) - 1, level);
    }
}

void write(OutputFile& file, const ContentsView& contents, const WriteOptions& options) {
    const Pictures pictures = arrange(file, contents);
    require_exr_levels(file, pictures.levels);
    try {
        Output stream(file);
        const Imf::Header header = make_header(contents, pictures, options);
        const Imf::PixelType type = options.format == TexelFormat::rgba32f ? Imf::FLOAT : Imf::HALF;
        write_levels(stream, header, pictures.levels, type);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        file.fail(error.what());
    }
}

}  // namespace

const Codec kExr = {
    .name = "OpenEXR",
    .endings = {".exr"},
    .texel_formats = {TexelFormat::rgba16f, TexelFormat::rgba32f},
    .recognises = recognises,
    .read = read,
    .write = write,
    .holds_cubes = true,
    .holds_levels = true,
    .open_rows = open_rows,
};

}  // namespace mirrorball::detail
