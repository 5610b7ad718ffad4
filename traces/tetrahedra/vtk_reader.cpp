#include "traces/tetrahedra/vtk_reader.hpp"

#include "traces/tetrahedra/vtk_values.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace traces {

namespace {

constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
constexpr double tetrahedron = 10; // VTK_TETRA

std::string upper(std::string_view word) {
    std::string text(word);
    for (char& letter : text)
        if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
    return text;
}

/// Corners of all cells, one after the other, and where each cell begins.
struct Cells {
    std::vector<double> corners;
    std::vector<std::size_t> begin{0};

    std::size_t count() const { return begin.size() - 1; }
};

class VtkFile {
  public:
    explicit VtkFile(InputBytes file) : file_(std::move(file)), values_(file_, read_header()) {}

    TetrahedralMesh read() {
        mesh_.name = "tetrahedra";
        while (!done_ && !file_.next_word().empty()) section(upper(file_.word()));
        require(points_, "POINTS");
        require(cells_.has_value(), "CELLS");
        require(!types_.empty(), "CELL_TYPES");
        add_tetrahedra();
        if (mesh_.scalars.empty()) add_computed_scalars(mesh_);
        return std::move(mesh_);
    }

  private:
    enum class Owner : std::uint8_t { grid, points, cells };

    /// True when the values are binary.
    bool read_header() {
        file_.require_at_line(file_.line().starts_with("# vtk DataFile Version "), "'# vtk DataFile Version N'");
        file_.line(); // a title
        const std::string format = upper(file_.word());
        file_.require_at_line(format == "ASCII" || format == "BINARY", "ASCII or BINARY, got {}", in_quotes(format));
        return format == "BINARY";
    }

    void require(bool found, std::string_view section) const {
        file_.require_at_line(found, "a section {} before the end of the file", section);
    }

    void section(const std::string& keyword) {
        if (keyword == "DATASET") return dataset();
        if (keyword == "POINTS") return points();
        if (keyword == "CELLS") return cells();
        if (keyword == "CELL_TYPES") return cell_types();
        if (keyword == "POINT_DATA" || keyword == "CELL_DATA") return begin_data(keyword);
        if (keyword == "FIELD") return field();
        if (keyword == "SCALARS") return scalars();
        if (keyword == "METADATA") return metadata();
        if (keyword == "LOOKUP_TABLE") return lookup_table();
        if (keyword == "VECTORS" || keyword == "NORMALS") return skip_tuples(3);
        if (keyword == "TENSORS") return skip_tuples(9);
        if (keyword == "TENSORS6") return skip_tuples(6);
        if (keyword == "GLOBAL_IDS" || keyword == "PEDIGREE_IDS" || keyword == "EDGE_FLAGS") return skip_tuples(1);
        if (keyword == "TEXTURE_COORDINATES") return texture_coordinates();
        if (keyword == "COLOR_SCALARS") return colours();
        file_.fail_at_line(fmt::format("a section of an unstructured grid, got {}", in_quotes(keyword)));
    }

    void dataset() {
        const std::string_view kind = file_.word();
        file_.require_at_line(upper(kind) == "UNSTRUCTURED_GRID", "UNSTRUCTURED_GRID, got {}", in_quotes(kind));
    }

    void points() {
        const std::uint64_t count = read_count(file_, most, "number of points");
        const std::vector<double> values = values_.read(count * 3, file_.word(), "points");
        mesh_.positions.clear();
        for (std::size_t i = 0; i < values.size(); i += 3)
            mesh_.positions.emplace_back(glm::vec3(glm::dvec3(values[i], values[i + 1], values[i + 2])));
        points_ = true;
    }

    void cells() {
        const std::uint64_t first = read_count(file_, most, "number of cells");
        const std::uint64_t second = read_count(file_, most * 9, "number of corners");
        cells_.emplace();
        if (upper(file_.next_word()) == "OFFSETS")
            cells_by_offsets(first, second);
        else
            cells_by_counts(first, second);
    }

    void cells_by_counts(std::uint64_t count, std::uint64_t numbers) {
        const std::vector<double> list = values_.read(numbers, "int", "cells");
        std::size_t at = 0;
        for (std::uint64_t cell = 0; cell < count; ++cell) {
            const double corners = at < list.size() ? list[at] : -1.0;
            file_.require_at_line(corners >= 0.0 && corners <= static_cast<double>(list.size() - at - 1),
                                  "the corners of cell {} among the {} numbers of CELLS", cell, numbers);
            const auto begin = list.begin() + static_cast<std::ptrdiff_t>(at) + 1;
            cells_->corners.insert(cells_->corners.end(), begin, begin + static_cast<std::ptrdiff_t>(corners));
            cells_->begin.push_back(cells_->corners.size());
            at += 1 + static_cast<std::size_t>(corners);
        }
        file_.require_at_line(at == list.size(), "{} numbers for {} cells, got {}", at, count, list.size());
    }

    // Version 5: one offset more than there are cells.
    void cells_by_offsets(std::uint64_t offsets, std::uint64_t corners) {
        file_.word();
        const std::vector<double> begin = values_.read(offsets, file_.word(), "cell offsets");
        const std::string_view keyword = file_.word();
        file_.require_at_line(upper(keyword) == "CONNECTIVITY", "CONNECTIVITY, got {}", in_quotes(keyword));
        cells_->corners = values_.read(corners, file_.word(), "cell corners");
        for (std::size_t i = 0; i < begin.size(); ++i) {
            const double least = i == 0 ? 0.0 : begin[i - 1];
            const double largest = i == 0 ? 0.0 : static_cast<double>(corners);
            file_.require_at_line(begin[i] >= least && begin[i] <= largest,
                                  "an offset from {} to {}, got {} for cell {}", least, largest, begin[i], i);
            if (i > 0) cells_->begin.push_back(static_cast<std::size_t>(begin[i]));
        }
    }

    void cell_types() {
        const std::uint64_t count = read_count(file_, most, "number of cell types");
        types_ = values_.read(count, "int", "cell types");
    }

    void begin_data(const std::string& keyword) {
        owner_ = keyword == "POINT_DATA" ? Owner::points : Owner::cells;
        tuples_ = read_count(file_, most, "number of values");
        file_.require_at_line(owner_ != Owner::points || tuples_ == mesh_.positions.size(),
                              "POINT_DATA for {} points, got {}", mesh_.positions.size(), tuples_);
    }

    void scalars() {
        file_.word(); // a name
        const std::string type(file_.word());
        std::uint64_t components = 1;
        if (const std::string_view next = file_.next_word(); !next.empty() && next[0] >= '0' && next[0] <= '9')
            components = read_count(file_, 4, "number of components");
        if (upper(file_.next_word()) == "LOOKUP_TABLE") {
            file_.word();
            file_.word(); // its name
        }
        file_.require_at_line(components > 0, "1 to 4 components, got 0");
        if (owner_ != Owner::points) return values_.skip(tuples_ * components, type, "cell scalars");
        take_scalars(values_.read(tuples_ * components, type, "scalars"), components);
        done_ = cells_.has_value() && !types_.empty();
    }

    // The scalars of SCALARS go before those of a FIELD, which several tools write for everything else.
    void field() {
        file_.word(); // a name
        const std::uint64_t arrays = read_count(file_, 1'000'000, "number of arrays");
        for (std::uint64_t i = 0; i < arrays; ++i) {
            if (file_.next_word() == "METADATA") {
                file_.word();
                metadata();
            }
            file_.word(); // a name
            const std::uint64_t components = read_count(file_, 1'000'000, "number of components");
            const std::uint64_t tuples = read_count(file_, most, "number of tuples");
            const std::string type(file_.word());
            if (owner_ == Owner::points && components == 1 && tuples == mesh_.positions.size() && mesh_.scalars.empty())
                take_scalars(values_.read(tuples, type, "field"), 1);
            else if (upper(type) == "STRING" || upper(type) == "UTF8_STRING")
                values_.skip_strings(tuples * components);
            else
                values_.skip(tuples * components, type, "field");
        }
    }

    void take_scalars(const std::vector<double>& values, std::uint64_t components) {
        constexpr double largest = std::numeric_limits<float>::max();
        mesh_.scalars.clear();
        for (std::size_t i = 0; i < values.size(); i += components)
            mesh_.scalars.push_back(static_cast<float>(std::clamp(values[i], -largest, largest)));
    }

    void metadata() {
        file_.line();
        while (file_.left() > 0 && !file_.line().empty()) {
        }
    }

    void lookup_table() {
        file_.word(); // a name
        const std::uint64_t entries = read_count(file_, most, "number of colours");
        values_.skip(entries * 4, "unsigned_char", "colours");
    }

    void colours() {
        file_.word(); // a name
        const std::uint64_t components = read_count(file_, 1'000'000, "number of components");
        values_.skip(tuples_ * components, "unsigned_char", "colours");
    }

    void texture_coordinates() {
        file_.word(); // a name
        const std::uint64_t components = read_count(file_, 3, "number of components");
        const std::string type(file_.word());
        values_.skip(tuples_ * components, type, "texture coordinates");
    }

    void skip_tuples(std::uint64_t components) {
        file_.word(); // a name
        const std::string type(file_.word());
        values_.skip(tuples_ * components, type, "attributes");
    }

    void add_tetrahedra() {
        file_.require_at_line(types_.size() == cells_->count(), "{} cell types, one per cell, got {}", cells_->count(),
                              types_.size());
        std::size_t others = 0;
        for (std::size_t cell = 0; cell < types_.size(); ++cell)
            if (types_[cell] == tetrahedron)
                add_tetrahedron(cell);
            else
                ++others;
        file_.require_at_line(!mesh_.tetrahedra.empty(), "at least one tetrahedron (cell type 10) among {} cells",
                              types_.size());
        if (others > 0) mesh_.notes.push_back(fmt::format("{} cells that are no tetrahedra are left out", others));
    }

    void add_tetrahedron(std::size_t cell) {
        const std::size_t begin = cells_->begin[cell], corners = cells_->begin[cell + 1] - begin;
        file_.require_at_line(corners == 4, "4 corners of tetrahedron {}, got {}", cell, corners);
        std::array<std::uint32_t, 4> one{};
        for (std::size_t i = 0; i < 4; ++i) {
            const double vertex = cells_->corners[begin + i];
            file_.require_at_line(vertex >= 0.0 && vertex < static_cast<double>(mesh_.positions.size()),
                                  "the number of one of {} points, got {} in cell {}", mesh_.positions.size(), vertex,
                                  cell);
            one[i] = static_cast<std::uint32_t>(vertex);
        }
        mesh_.tetrahedra.push_back(one);
    }

    InputBytes file_;
    VtkValues values_;
    TetrahedralMesh mesh_;
    std::optional<Cells> cells_;
    std::vector<double> types_;
    bool points_ = false;
    bool done_ = false; ///< nothing that follows is needed
    Owner owner_ = Owner::grid;
    std::uint64_t tuples_ = 0; ///< of the present owner
};

} // namespace

TetrahedralMesh read_vtk(InputBytes file) { return VtkFile(std::move(file)).read(); }

} // namespace traces
