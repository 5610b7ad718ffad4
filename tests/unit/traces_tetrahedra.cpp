// Meshes of tetrahedra: their faces, the scenes made of them, and what both readers take and refuse.
#include "pipeline/functional/vertex_fetch.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/scene_files.hpp"
#include "traces/scene.hpp"
#include "traces/tetrahedra/tetrahedral_mesh.hpp"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace traces_tetrahedra_test {

using support::TemporaryFolder;
using traces::Scene;

const std::string header = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const std::string points = "POINTS 5 float\n0 0 0  1 0 0  0 1 0  0 0 1  1 1 1\n";
const std::string cells = "CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10 10\n";
const std::string scalars = "POINT_DATA 5\nSCALARS s float 1\nLOOKUP_TABLE default\n0 1 2 3 4.5\n";

Scene load(const std::string& name, const std::string& bytes) {
    const TemporaryFolder folder;
    return traces::load_scene(folder.write(name, bytes).string());
}

std::string error(const std::string& name, const std::string& bytes) {
    const TemporaryFolder folder;
    return support::load_error(folder.write(name, bytes).string(), folder.path());
}

std::string vtk_error(const std::string& bytes) { return error("mesh.vtk", bytes); }

float scalar_at(const Scene& scene, std::uint32_t vertex) {
    const auto& colour = *scene.resources->geometries[0].find(pipeline::Semantic::colour);
    return pipeline::AttributeReader(*scene.resources, colour)(vertex).r;
}

template <class T>
void append(std::string& bytes, const std::vector<T>& values, bool big_endian) {
    for (const T value : values) {
        std::string one(sizeof(T), '\0');
        std::memcpy(one.data(), &value, sizeof(T));
        bytes += big_endian ? std::string(one.rbegin(), one.rend()) : one;
    }
}

std::string tetm(std::uint32_t version = 1) {
    std::string bytes = "TETM";
    append<std::uint32_t>(bytes, {version, 4, 1}, false);
    append<float>(bytes, {0, 3, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 2, 3}, false);
    append<std::uint32_t>(bytes, {0, 1, 2, 3}, false);
    return bytes;
}

TEST(Tetrahedra, FacesAreNamedOnceHoweverManyShareThem) {
    EXPECT_EQ(traces::faces_of({{0, 1, 2, 3}}).size(), 4U);
    EXPECT_EQ(traces::faces_of({{0, 1, 2, 3}, {1, 2, 3, 4}}).size(), 7U);
    EXPECT_EQ(traces::faces_of({{0, 1, 2, 3}, {3, 2, 1, 0}}).size(), 4U);
    // Two equal corners: the two faces that have both are no triangles, the other two are the same one.
    EXPECT_EQ(traces::faces_of({{0, 1, 2, 2}}).size(), 1U);
}

TEST(Tetrahedra, ASceneIsOneDrawOfAllFacesWithTheScalarAsRed) {
    const Scene scene = load("mesh.vtk", header + points + cells + scalars);
    ASSERT_EQ(scene.draws.size(), 1U);
    EXPECT_EQ(scene.triangles, 7U);
    EXPECT_EQ(scene.triangles_drawn, 7U);
    EXPECT_EQ(scene.vertices, 5U);
    EXPECT_EQ(scene.name, "mesh.vtk");
    EXPECT_TRUE(scene.notes.empty());
    EXPECT_TRUE(scene.resources->materials[0].unlit && scene.resources->materials[0].double_sided);
    EXPECT_EQ(scalar_at(scene, 4), 4.5F);
    EXPECT_EQ(scene.hi, glm::vec3(1.0F));
}

TEST(Tetrahedra, LargeScalarsAreBroughtIntoTheRangeOfColours) {
    const Scene scene =
        load("mesh.vtk",
             header + points + cells + "POINT_DATA 5\nSCALARS s double\nLOOKUP_TABLE default\n0 1e6 -4e6 1 1e38\n");
    float largest = 0.0F;
    for (std::uint32_t i = 0; i < 5; ++i) largest = std::max(largest, std::fabs(scalar_at(scene, i)));
    EXPECT_LE(largest, 65504.0F);
    EXPECT_GT(largest, 30000.0F);
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].find("divided by 2^"), std::string::npos);
}

TEST(Vtk, WithoutScalarsTheDistanceFromTheMiddleIsTaken) {
    const Scene scene = load("mesh.vtk", header + points + cells);
    EXPECT_EQ(scalar_at(scene, 0), 1.0F); // a corner of the box
    EXPECT_NEAR(scalar_at(scene, 1), 1.0F, 1e-6F);
    ASSERT_EQ(scene.notes.size(), 1U);
}

TEST(Vtk, BinaryFilesAreBigEndian) {
    std::string bytes = "# vtk DataFile Version 3.0\ntitle\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n";
    append<double>(bytes, {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}, true);
    bytes += "\nCELLS 1 5\n";
    append<std::int32_t>(bytes, {4, 0, 1, 2, 3}, true);
    bytes += "\nCELL_TYPES 1\n";
    append<std::int32_t>(bytes, {10}, true);
    bytes += "\nPOINT_DATA 4\nSCALARS s short 1\nLOOKUP_TABLE default\n";
    append<std::int16_t>(bytes, {-7, 1, 2, 300}, true);
    const Scene scene = load("mesh.vtk", bytes);
    EXPECT_EQ(scene.triangles, 4U);
    EXPECT_EQ(scene.hi, glm::vec3(1.0F, 2.0F, 3.0F));
    EXPECT_EQ(scalar_at(scene, 0), -7.0F);
    EXPECT_EQ(scalar_at(scene, 3), 300.0F);
    EXPECT_EQ(vtk_error(bytes.substr(0, bytes.size() - 2)), "mesh.vtk: byte " + std::to_string(bytes.size() - 8) +
                                                                ": expected 4 numbers of 2 bytes for scalars, got 6 "
                                                                "bytes");
}

TEST(Vtk, CellsOfVersionFiveAndFieldsAreRead) {
    const Scene scene =
        load("mesh.vtk", "# vtk DataFile Version 5.1\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n" + points +
                             "METADATA\nINFORMATION 0\n\nCELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\n"
                             "CONNECTIVITY vtktypeint64\n0 1 2 3 1 2 3 4\nCELL_TYPES 2\n10\n10\n"
                             "CELL_DATA 2\nSCALARS c float 1\nLOOKUP_TABLE default\n9 9\n"
                             "POINT_DATA 5\nVECTORS v float\n1 2 3 1 2 3 1 2 3 1 2 3 1 2 3\n"
                             "FIELD FieldData 1\ns 1 5 float\n5 6 7 8 9\n");
    EXPECT_EQ(scene.triangles, 7U);
    EXPECT_EQ(scalar_at(scene, 4), 9.0F);
}

TEST(Vtk, WhatOtherProgramsWriteIsReadOrSkipped) {
    const Scene scene = load(
        "mesh.vtk",
        "# vtk DataFile Version 5.1\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 2\nTIME 1 1 double\n0\n"
        "names 1 2 string\none two\nthree\n" +
            points +
            "CELLS 3 8\nOFFSETS vtktypeint32\n0 4 8\nCONNECTIVITY vtktypeint32\n0 1 2 3 1 2 3 4\nCELL_TYPES 2\n10\n10\n"
            "CELL_DATA 2\nGLOBAL_IDS ids vtkIdType\n0 1\nPOINT_DATA 5\nCOLOR_SCALARS rgb 2\n0 1 0 1 0 1 0 1 0 nan\n"
            "TEXTURE_COORDINATES uv 2 float\n0 0 0 0 0 0 0 0 0 0\nTENSORS6 t float\n"
            "1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6\nNORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1 0 0 "
            "1\nSCALARS s Float\nLOOKUP_TABLE default\n"
            "+0.5 1E+1 -2e-400 .25 1.\n");
    EXPECT_EQ(scene.triangles, 7U);
    EXPECT_EQ(scalar_at(scene, 0), 0.5F);
    EXPECT_EQ(scalar_at(scene, 1), 10.0F);
    EXPECT_EQ(scalar_at(scene, 2), 0.0F);
    EXPECT_EQ(scalar_at(scene, 4), 1.0F);
    EXPECT_NE(vtk_error(header + points + cells + "POINT_DATA 5\nSCALARS s float\nLOOKUP_TABLE d\n+-1 1 1 1 1\n"), "");
}

TEST(Vtk, BinaryBitsColoursAndStringsAreSteppedOver) {
    std::string bytes = "# vtk DataFile Version 5.1\ntitle\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n";
    append<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}, true);
    bytes += "\nMETADATA\nINFORMATION 0\n\nCELLS 2 4\nOFFSETS vtktypeint64\n";
    append<std::int64_t>(bytes, {0, 4}, true);
    bytes += "\nCONNECTIVITY vtktypeint32\n";
    append<std::int32_t>(bytes, {0, 1, 2, 3}, true);
    bytes += "\nCELL_TYPES 1\n";
    append<std::int32_t>(bytes, {10}, true);
    bytes += "\nPOINT_DATA 4\nCOLOR_SCALARS rgb 3\n" + std::string(12, '\xff');
    bytes += "\nEDGE_FLAGS e bit\n" + std::string(1, '\x55');
    bytes += "\nFIELD f 1\nnames 1 2 string\n\xc1"
             "a"
             "\x80\x02"
             "bc";
    bytes += "\nSCALARS s vtktypefloat64 1\nLOOKUP_TABLE default\n";
    append<double>(bytes, {1, 2, 3, 4}, true);
    const Scene scene = load("mesh.vtk", bytes);
    EXPECT_EQ(scene.triangles, 4U);
    EXPECT_EQ(scalar_at(scene, 3), 4.0F);
}

TEST(Vtk, CellsThatAreNoTetrahedraAreLeftOutWithANote) {
    const Scene scene =
        load("mesh.vtk", header + points + "CELLS 2 9\n4 0 1 2 3\n3 1 2 3\nCELL_TYPES 2\n10 5\n" + scalars);
    EXPECT_EQ(scene.triangles, 4U);
    EXPECT_EQ(scene.notes, (std::vector<std::string>{"1 cells that are no tetrahedra are left out"}));
}

TEST(Vtk, MistakesAreNamedWithTheirLine) {
    EXPECT_EQ(vtk_error(""), "mesh.vtk: line 1: expected '# vtk DataFile Version N'");
    EXPECT_EQ(vtk_error("# vtk DataFile Version 3.0\nt\nTEXT\n"),
              "mesh.vtk: line 3: expected ASCII or BINARY, got 'TEXT'");
    EXPECT_EQ(vtk_error("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n"),
              "mesh.vtk: line 4: expected UNSTRUCTURED_GRID, got 'POLYDATA'");
    EXPECT_EQ(vtk_error(header + "POINTS -1 float\n"),
              "mesh.vtk: line 5: expected number of points from 0 to 4294967295, got '-1'");
    EXPECT_EQ(vtk_error(header + "POINTS 4000000000 float\n0 0 0\n"),
              "mesh.vtk: line 5: expected 12000000000 numbers for points, got 7 bytes");
    EXPECT_EQ(vtk_error(header + "POINTS 1 floats\n0 0 0\n"),
              "mesh.vtk: line 5: expected a numeric type such as float, got 'floats'");
    EXPECT_EQ(vtk_error(header + "POINTS 1 float\n0 nan 0\n"),
              "mesh.vtk: line 6: expected a finite number for points, got 'nan'");
    EXPECT_EQ(vtk_error(header + points + "CELLS 1 5\n4 0 1 2\n"),
              "mesh.vtk: line 9: expected a finite number for cells, got the end of the file");
    EXPECT_EQ(vtk_error(header + points + "CELLS 1 5\n9 0 1 2 3\nCELL_TYPES 1\n10\n"),
              "mesh.vtk: line 8: expected the corners of cell 0 among the 5 numbers of CELLS");
    EXPECT_EQ(vtk_error(header + points + "CELLS 1 5\n4 0 1 2 5\nCELL_TYPES 1\n10\n"),
              "mesh.vtk: line 10: expected the number of one of 5 points, got 5 in cell 0");
    EXPECT_EQ(vtk_error(header + points + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n"),
              "mesh.vtk: line 10: expected at least one tetrahedron (cell type 10) among 1 cells");
    EXPECT_EQ(vtk_error(header + points + cells + "POINT_DATA 4\n"),
              "mesh.vtk: line 12: expected POINT_DATA for 5 points, got 4");
    EXPECT_EQ(vtk_error(header + points), "mesh.vtk: line 6: expected a section CELLS before the end of the file");
    EXPECT_EQ(vtk_error(header + "POLYGONS 1 4\n"),
              "mesh.vtk: line 5: expected a section of an unstructured grid, got 'POLYGONS'");
}

TEST(Vtk, EveryCutFileIsRefusedOrReadWithoutScalars) {
    const std::string whole = header + points + cells + scalars;
    const std::size_t needed = (header + points + cells).size() - 3; // the last "10" may lose its end of line
    for (std::size_t size = 0; size < needed; ++size)
        EXPECT_NE(vtk_error(whole.substr(0, size)), "") << size << " bytes";
}

TEST(Tetm, IsReadAsItLies) {
    const Scene scene = load("mesh.tetm", tetm());
    EXPECT_EQ(scene.triangles, 4U);
    EXPECT_EQ(scalar_at(scene, 3), 3.0F);
    EXPECT_EQ(scene.hi, glm::vec3(1.0F));
}

TEST(Tetm, MistakesAreNamedWithTheirPlace) {
    EXPECT_EQ(error("mesh.tetm", "TET"), "mesh.tetm: byte 0: expected 4 bytes of magic, got 3");
    EXPECT_EQ(error("mesh.tetm", "ABCD"), "mesh.tetm: byte 4: expected the magic 'TETM', got 'ABCD'");
    EXPECT_EQ(error("mesh.tetm", tetm(2)), "mesh.tetm: byte 8: expected version 1, got 2");
    for (std::size_t size = 0; size < tetm().size(); ++size)
        EXPECT_NE(error("mesh.tetm", tetm().substr(0, size)), "") << size << " bytes";
    EXPECT_EQ(error("mesh.tetm", tetm() + "x"),
              "mesh.tetm: byte 24: expected 80 bytes for 4 vertices and 1 tetrahedra, got 81");
    std::string bytes = tetm();
    bytes[bytes.size() - 4] = 4;
    EXPECT_EQ(error("mesh.tetm", bytes), "mesh.tetm: byte 104: expected a vertex below 4, got 4 in tetrahedron 0");
    bytes = tetm();
    for (std::size_t i = 8; i < 16; ++i) bytes[i] = static_cast<char>(0xFF);
    EXPECT_NE(error("mesh.tetm", bytes).find("expected 137438953440 bytes"), std::string::npos);
}

TEST(Tetrahedra, TheFilesOfTheSharedFolderHaveTheCountsTheirTextsState) {
    const auto combustor = ropsim_test::shared_file("scenes/combustor_tet/combustor_tet.tetm");
    const auto bunny = ropsim_test::shared_file("scenes/bunny_tet/bunny_tet.vtk");
    if (!combustor || !bunny) GTEST_SKIP() << "no folder of shared scenes";
    const Scene a = traces::load_scene(combustor->string());
    EXPECT_EQ(a.vertices, 47025U);
    // Boundary faces belong to one tetrahedron, all others to two: 2 faces = 4 tetrahedra + boundary.
    const std::uint64_t boundary = 2 * a.triangles - 4 * 215040;
    EXPECT_EQ(boundary, 2U * 2 * (56 * 32 + 56 * 24 + 32 * 24)); // two triangles per outer cell face of 57 x 33 x 25
    const Scene b = traces::load_scene(bunny->string());
    EXPECT_EQ(b.vertices, 5433U);
    EXPECT_EQ(2 * b.triangles - 4 * 34055, 670U); // its LICENSE.txt: 670 boundary faces
    EXPECT_TRUE(b.notes.empty());
}

} // namespace traces_tetrahedra_test
