#include "app/scene/export_advice.h"

#include <algorithm>
#include <cctype>

namespace neve::app::scene {

namespace {

struct FormatAdvice {
  std::string_view words;  ///< formats and programs, each between blanks
  const char* text;
};

constexpr FormatAdvice formats_elsewhere[] = {
    {" abc alembic ", "Alembic is not written; Houdini reads bgeo and usda, Blender ply and usda"},
    {" blend blender ", "Blender reads ply and usda, and vdb for volumes"},
    {" hip geo bgeo.sc houdini mantra partio ", "Houdini reads bgeo and usda, and vdb for volumes"},
    {" usd usdc usdz maya ma mb c4d cinema4d unreal unity max 3dsmax omniverse hydra katana ",
     "usda is the format of USD that is written"},
    {" fbx gltf glb dae collada x3d ",
     "those have no particles; usda has, and a mesh with --surface"},
    {" stl off 3mf ", "a mesh of the snow is ply or obj with --surface"},
    {" vtk vtu vtr vtm pvd paraview visit ",
     "ParaView reads vtp for particles and vti for the grid"},
    {" openvdb nvdb nanovdb ", "vdb is the format of OpenVDB"},
    {" npy numpy mat matlab h5 hdf5 hdf pickle python ", "npz has arrays for numpy"},
    {" txt tsv json xls xlsx excel pandas parquet dat ", "csv is the format for tables"},
    {" prt pc2 mdd ptc pts xyz las ", "ply and csv have points for other programs"}};

}  // namespace

std::string export_format_advice(std::string_view word) {
  std::string wanted(word.starts_with('.') ? word.substr(1) : word);
  std::transform(wanted.begin(), wanted.end(), wanted.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (wanted.empty() || wanted.find(' ') != std::string::npos) return {};
  wanted = " " + wanted + " ";
  for (const FormatAdvice& one : formats_elsewhere)
    if (one.words.find(wanted) != std::string_view::npos) return one.text;
  return {};
}

}  // namespace neve::app::scene
