// Rows on their way from a file to a caller: fetched (decoded, three channels, linear), looked at,
// and repaired where they have to be.
//
// Repair takes a hole's new texels from those around it, above and below too. Rows without a hole
// are never changed by it, and nothing reaches across one. So the rows between two such rows are
// repaired by themselves, to the same bits as in the whole map; only they are kept back.
#include <mirrorball/row_reader.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <mirrorball/error.h>

#include "codec.h"
#include "core/parallel.h"
#include "face_pattern.h"
#include "face_words.h"
#include "image/statistics_sum.h"
#include "map_metadata.h"
#include "map_shape.h"
#include "repair.h"
#include "row_source.h"
#include "texel_use.h"

namespace mirrorball {

using namespace detail;

class RowReader::State {
  public:
    // Where the rows cannot be had one by one: read the whole, or leave it.
    enum class Otherwise { read_whole, leave };

    State(const std::string& source, const MapReadOptions& options, Otherwise otherwise)
        : name_(source),
          options_(options) {
        std::string obstacle;
        if (!open_rows(obstacle)) {
            if (otherwise == Otherwise::leave) return;
            read_whole(obstacle);
        }
        if (otherwise == Otherwise::read_whole) require_equirect();
    }

    void check_memory() const {
        if (bytes_held() > options_.memory_limit) {
            const auto mib = [](std::uint64_t count) { return double(count) / (1024 * 1024); };
            throw Error(Errc::cannot_read,
                        fmt::format("{}: reading its rows takes {:.1f} MiB of memory, and the "
                                    "limit is {:.1f} MiB",
                                    name_, mib(bytes_held()), mib(options_.memory_limit)));
        }
    }

    int read(std::span<float> rows) {
        const std::size_t size = row_size();
        const int wanted =
            static_cast<int>(std::min<std::size_t>(rows.size() / size, height - given_));
        for (int done = 0; done < wanted;)
            done += read_some(rows.subspan(done * size, (wanted - done) * size));
        given_ += wanted;
        if (wanted > 0 && given_ == height) note_what_was_found();
        return wanted;
    }

    [[nodiscard]] std::size_t row_size() const { return std::size_t{3} * width; }
    [[nodiscard]] int rows_at_once() const {
        return std::min(height, rows_ ? rows_->rows_at_once() : 64);
    }
    [[nodiscard]] std::uint64_t bytes_held() const {
        if (!rows_) return environment_map_bytes(Projection::equirect, width);
        const std::uint64_t row_bytes = sizeof(float) * row_size();
        const int channels = rows_->header.channels;
        const std::uint64_t other_channels =
            channels == 3 ? 0 : sizeof(float) * width * channels * std::uint64_t(rows_at_once());
        const std::uint64_t kept_back = options_.repair ? row_bytes * 2 * kMostRowsOfHoles : 0;
        return rows_->bytes_held() + other_channels + kept_back;
    }
    [[nodiscard]] bool streams() const { return rows_ != nullptr; }
    [[nodiscard]] int given() const { return given_; }

    Projection projection = Projection::equirect;
    int width = 0, height = 0;
    Axes axes;
    std::optional<Lobe> lobe;
    std::string format;
    TexelFormat stored = TexelFormat::automatic;
    Metadata metadata;
    std::vector<std::string> notes;

  private:
    static constexpr int kMostRowsOfHoles = 256;
    using Row = std::vector<float>;

    // Open ------------------------------------------------------------------------------------

    [[noreturn]] void fail(Errc code, const std::string& what) const {
        throw Error(code, fmt::format("{}: {}", name_, what));
    }

    // False where the rows cannot be had one by one, with the reason if it is this file's own.
    bool open_rows(std::string& obstacle) {
        std::error_code ignored;
        if (is_face_pattern(name_) || !std::filesystem::is_regular_file(name_, ignored))
            return false;
        file_ = std::make_unique<InputFile>(std::filesystem::path(name_));
        const Codec& codec = codec_for_contents(*file_);
        if (codec.open_rows == nullptr) {
            obstacle =
                fmt::format("{} files have no rows that can be read by themselves", codec.name);
            return false;
        }
        rows_ = codec.open_rows(*file_, options_, obstacle);
        if (!rows_) return false;

        const RowSource::Header& header = rows_->header;
        width = header.width;
        height = header.height;
        format = codec.name;
        stored = header.stored;
        metadata = header.metadata;
        notes = header.notes;
        is_srgb_ = floats_are_srgb(stored, options_.transfer);
        if (is_srgb_) notes.emplace_back(kTakenAsSrgb);
        note_misleading_name(*file_, codec, notes);

        const MapWords words = parse_words(metadata, name_);
        const StoredPictures pictures{1, width, height};
        const Shape shape = decide_shape(name_, pictures, words, options_, notes);
        projection = shape.projection;
        axes = decide_axes(shape.projection, pictures, words, options_);
        if (words.lobes && !words.lobes->empty()) lobe = words.lobes->front();
        if (!words.lobes && words.irradiance) lobe = Lobe{Lobe::Kind::diffuse};
        return true;
    }

    void read_whole(const std::string& obstacle) {
        file_.reset();
        LoadedMap loaded = read_map(name_, options_);
        projection = loaded.map.projection;
        Level& level = loaded.map.levels.front();
        width = level.width();
        height = level.height();
        axes = loaded.map.axes;
        lobe = level.lobe;
        format = loaded.format;
        stored = loaded.stored;
        metadata = std::move(loaded.metadata);
        notes = std::move(loaded.notes);
        if (!obstacle.empty()) notes.push_back("is read whole, as " + obstacle);
        whole_ = std::move(level.faces.front());
    }

    void require_equirect() const {
        if (projection == Projection::equirect) return;
        fail(Errc::usage, fmt::format("is {}; only equirect maps are read row by row",
                                      map_in_words(projection)));
    }

    // Fetch -----------------------------------------------------------------------------------

    // The next rows of the file as they are, in three linear channels.
    void fetch(std::span<float> rows) {
        const int count = static_cast<int>(rows.size() / row_size());
        const int channels = rows_->header.channels;
        if (channels == 3) {
            rows_->read(count, rows);
            if (is_srgb_) make_linear(rows, channels);
        } else {
            stored_.resize(std::size_t{static_cast<unsigned>(count)} * width * channels);
            rows_->read(count, stored_);
            if (is_srgb_) make_linear(stored_, channels);
            take_three_channels(channels, rows);
        }
        fetched_ += count;
    }

    void take_three_channels(int channels, std::span<float> rows) {
        const bool grey = channels < 3, has_alpha = channels != 1;
        const float* from = stored_.data();
        for (std::size_t i = 0; i < rows.size(); i += 3, from += channels) {
            for (int c = 0; c < 3; ++c) rows[i + c] = from[grey ? 0 : c];
            if (has_alpha && from[channels - 1] != 1) is_opaque_ = false;
        }
    }

    // Look ------------------------------------------------------------------------------------

    // Counts what is odd about rows that were just fetched; the first with a hole, or the count.
    int look_at(std::span<const float> rows) {
        const int count = static_cast<int>(rows.size() / row_size());
        std::vector<TexelFaults> found(count);
        parallel_for(count, [&](std::int64_t i) {
            found[i] = faults_in_row(rows.subspan(i * row_size(), row_size()), Projection::equirect,
                                     height, 0, fetched_ - count + static_cast<int>(i));
        });
        int first = count;
        for (int i = 0; i < count; ++i) {
            if (found[i].non_finite_count > 0) first = std::min(first, i);
            faults_.add(found[i]);
        }
        return first;
    }

    // So that an error can say how many there are.
    void look_at_rest() {
        Row row(row_size());
        while (fetched_ < height) {
            fetch(row);
            look_at(row);
        }
    }

    void note_what_was_found() {
        if (!rows_) return;
        if (!is_opaque_) notes.emplace_back(kAlphaDropped);
        if (faults_.non_finite_count > 0)
            notes.push_back(repaired_in_words(Projection::equirect, 0, faults_));
        if (faults_.negative_count > 0) notes.push_back(negative_in_words(0, faults_));
    }

    // Give ------------------------------------------------------------------------------------

    // Some of the rows asked for, or none where they have to wait for others.
    int read_some(std::span<float> rows) {
        if (!rows_) {
            const std::span<const float> from(whole_.at(0, whole_given_), rows.size());
            std::copy(from.begin(), from.end(), rows.begin());
            const int count = static_cast<int>(rows.size() / row_size());
            whole_given_ += count;
            return count;
        }
        if (!repaired_.empty()) {
            std::copy(repaired_.front().begin(), repaired_.front().end(), rows.begin());
            repaired_.pop_front();
            return 1;
        }
        const int asked = static_cast<int>(rows.size() / row_size());
        const int count = std::min(asked, rows_at_once());
        rows = rows.first(count * row_size());
        fetch(rows);
        const int good = look_at(rows);
        if (good < count && !options_.repair) {
            look_at_rest();
            fail(Errc::cannot_read, non_finite_in_words(Projection::equirect, 0, faults_));
        }
        if (options_.repair && good > 0) {
            const auto last = rows.subspan((good - 1) * row_size(), row_size());
            above_.assign(last.begin(), last.end());
        }
        if (good < count) repair_rows(rows.subspan(good * row_size()));
        return good;
    }

    static bool has_hole(const Row& row) {
        return !std::all_of(row.begin(), row.end(), [](float v) { return std::isfinite(v); });
    }

    // Moves these rows, and as many as the last hole needs, to `repaired_`.
    void repair_rows(std::span<const float> rows) {
        std::deque<Row> waiting;
        for (std::size_t i = 0; i < rows.size(); i += row_size())
            waiting.emplace_back(rows.begin() + i, rows.begin() + i + row_size());
        while (!waiting.empty()) {
            std::vector<Row> block;
            do {
                if (waiting.empty()) waiting.push_back(next_row());
                block.push_back(std::move(waiting.front()));
                waiting.pop_front();
            } while (has_hole(block.back()) && (!waiting.empty() || fetched_ < height) &&
                     block.size() < kMostRowsOfHoles);
            if (has_hole(block.front())) repair_block(block);
            above_ = block.back();
            for (Row& row : block) repaired_.push_back(std::move(row));
        }
    }

    Row next_row() {
        Row row(row_size());
        fetch(row);
        look_at(row);
        return row;
    }

    void repair_block(std::vector<Row>& block) {
        const int above = above_.empty() ? 0 : 1;
        if (block.size() == kMostRowsOfHoles && has_hole(block.back()))
            fail(Errc::cannot_read,
                 fmt::format("has a hole over {} rows, more than can be repaired row by row",
                             kMostRowsOfHoles));
        Level level;
        Image& image = level.faces.emplace_back(width, static_cast<int>(block.size()) + above, 3);
        if (above == 1) std::copy(above_.begin(), above_.end(), image.row(0).begin());
        for (std::size_t i = 0; i < block.size(); ++i)
            std::copy(block[i].begin(), block[i].end(),
                      image.row(static_cast<int>(i) + above).begin());
        const std::int64_t hole_count = find_faults(level, Projection::equirect).non_finite_count;
        if (repair(level, Projection::equirect) != hole_count) {
            look_at_rest();
            fail(Errc::cannot_read, beyond_repair_in_words(Projection::equirect, 0, faults_));
        }
        for (std::size_t i = 0; i < block.size(); ++i) {
            const std::span<const float> row = image.row(static_cast<int>(i) + above);
            block[i].assign(row.begin(), row.end());
        }
    }

    std::string name_;
    MapReadOptions options_;
    std::unique_ptr<InputFile> file_;
    std::unique_ptr<RowSource> rows_;  // none where the whole was read
    Image whole_;
    int whole_given_ = 0;
    bool is_srgb_ = false, is_opaque_ = true;
    int fetched_ = 0, given_ = 0;
    TexelFaults faults_;
    Row stored_;                // as the file has them, where that is not three channels
    Row above_;                 // the row before the next to be looked at; empty before the first
    std::deque<Row> repaired_;  // to be given next
};

RowReader::RowReader(const std::string& source, const MapReadOptions& options)
    : state_(std::make_unique<State>(source, options, State::Otherwise::read_whole)) {
    state_->check_memory();
}
RowReader::RowReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
RowReader::~RowReader() = default;
RowReader::RowReader(RowReader&&) noexcept = default;
RowReader& RowReader::operator=(RowReader&&) noexcept = default;

int RowReader::width() const {
    return state_->width;
}
int RowReader::height() const {
    return state_->height;
}
const Axes& RowReader::axes() const {
    return state_->axes;
}
const std::optional<Lobe>& RowReader::lobe() const {
    return state_->lobe;
}
const std::string& RowReader::format() const {
    return state_->format;
}
TexelFormat RowReader::stored() const {
    return state_->stored;
}
const Metadata& RowReader::metadata() const {
    return state_->metadata;
}
const std::vector<std::string>& RowReader::notes() const {
    return state_->notes;
}
std::size_t RowReader::row_size() const {
    return state_->row_size();
}
int RowReader::rows_at_once() const {
    return state_->rows_at_once();
}
std::uint64_t RowReader::bytes_held() const {
    return state_->bytes_held();
}
bool RowReader::streams() const {
    return state_->streams();
}
int RowReader::read(std::span<float> rows) {
    return state_->read(rows);
}
int RowReader::next_row() const {
    return state_->given();
}

std::optional<RowReader> open_if_larger(const std::string& source, const MapReadOptions& options,
                                        std::uint64_t most_bytes) {
    using State = RowReader::State;
    auto state = std::make_unique<State>(source, options, State::Otherwise::leave);
    if (!state->streams() || state->projection != Projection::equirect ||
        environment_map_bytes(Projection::equirect, state->width) <= most_bytes)
        return std::nullopt;
    state->check_memory();
    return RowReader(std::move(state));
}

namespace {

// Calls f(rows, y of the first, how many) until there are no more.
template <class F>
void for_each_batch(RowReader& rows, F&& f) {
    std::vector<float> batch(rows.rows_at_once() * rows.row_size());
    for (int y = rows.next_row();; y = rows.next_row()) {
        const int count = rows.read(batch);
        if (count == 0) return;
        f(std::span<const float>(batch).first(count * rows.row_size()), y, count);
    }
}

// A row made narrower by a factor, as sums.
void add_up(std::span<const float> row, int factor, std::span<double> sums) {
    const float* from = row.data();
    for (std::size_t i = 0; i < sums.size(); i += 3) {
        double red = 0, green = 0, blue = 0;
        for (int k = 0; k < factor; ++k, from += 3) {
            red += from[0];
            green += from[1];
            blue += from[2];
        }
        sums[i] = red, sums[i + 1] = green, sums[i + 2] = blue;
    }
}

}  // namespace

LevelStatistics statistics(RowReader& rows) {
    StatisticsSum sum;
    for_each_batch(rows, [&](std::span<const float> batch, int first, int count) {
        for (int i = 0; i < count; ++i) {
            const double solid_angle =
                texel_solid_angle(Projection::equirect, rows.width(), rows.height(), 0, first + i);
            const float* texel = &batch[i * rows.row_size()];
            for (int x = 0; x < rows.width(); ++x, texel += 3)
                sum.add({texel[0], texel[1], texel[2]}, solid_angle);
        }
    });
    return sum.result();
}

EnvironmentMap reduced(RowReader& rows, int factor) {
    if (factor < 1 || rows.height() % factor != 0)
        throw Error(Errc::usage, fmt::format("factor {}: a map of {} x {} is reduced by a divisor "
                                             "of its height",
                                             factor, rows.width(), rows.height()));
    EnvironmentMap map =
        make_environment_map({Projection::equirect, rows.width() / factor, rows.axes()});
    map.levels[0].lobe = rows.lobe();
    Image& image = map.levels[0].faces[0];

    const std::size_t row_size = rows.row_size(), reduced_size = row_size / factor;
    std::vector<double> sums(rows.rows_at_once() * reduced_size), mean(reduced_size);
    double weight = 0;
    for_each_batch(rows, [&](std::span<const float> batch, int first, int count) {
        parallel_for(count, [&](std::int64_t i) {
            add_up(batch.subspan(i * row_size, row_size), factor,
                   std::span(sums).subspan(i * reduced_size, reduced_size));
        });
        for (int i = 0; i < count; ++i) {
            const int y = first + i;
            const double solid_angle =
                texel_solid_angle(Projection::equirect, rows.width(), rows.height(), 0, y);
            weight += solid_angle * factor;
            const double* row = &sums[i * reduced_size];
            for (std::size_t x = 0; x < reduced_size; ++x) mean[x] += row[x] * solid_angle;
            if ((y + 1) % factor != 0) continue;
            const std::span<float> out = image.row(y / factor);
            for (std::size_t x = 0; x < reduced_size; ++x)
                out[x] = static_cast<float>(mean[x] / weight);
            std::fill(mean.begin(), mean.end(), 0.0);
            weight = 0;
        }
    });
    return map;
}

std::optional<int> factor_to_fit(const RowReader& rows, std::uint64_t most_bytes) {
    const std::uint64_t batch = sizeof(float) * rows.row_size() * rows.rows_at_once();
    for (int factor = 1; factor <= rows.height(); ++factor) {
        if (rows.height() % factor != 0) continue;
        const std::uint64_t sums = 2 * batch / factor;
        const std::uint64_t bytes =
            rows.bytes_held() + batch + sums +
            environment_map_bytes(Projection::equirect, rows.width() / factor);
        if (bytes <= most_bytes) return factor;
    }
    return std::nullopt;
}

}  // namespace mirrorball
