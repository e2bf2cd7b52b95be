#include "gfp/collection/model_collection.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <sstream>

#include "evaluation/mesh_table.hpp"
#include "gfp/core/mesh_io.hpp"
#include "gfp/frame/read_file.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;
using Classes = std::map<std::string, std::vector<ModelFile>>;

constexpr std::uintmax_t kMaxListBytes = 16U << 20U;
constexpr const char* kNoClass = "other";

bool is_mesh(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".off" || extension == ".obj" || extension == ".ply" || extension == ".stl";
}

std::vector<fs::path> files_below(const fs::path& folder, bool (*wanted)(const fs::path&)) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error), end; !error && entry != end; entry.increment(error))
    if (std::error_code ignored; entry->is_regular_file(ignored) && wanted(entry->path())) files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  return files;
}

bool names_a_file(const std::string& name) {
  const auto good = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; };
  return !name.empty() && name.size() <= 100 && name.front() != '.' && std::all_of(name.begin(), name.end(), good);
}

Error corrupt(const fs::path& file, std::size_t line, const std::string& what) { return {ErrorCode::kCorruptData, file.string() + ":" + std::to_string(line) + ": " + what}; }

/// A list's lines that say something, as words; with their numbers from 1.
struct Line {
  std::size_t number;
  std::vector<std::string> words;
};

std::vector<Line> lines_of(const std::string& text) {
  std::vector<Line> lines;
  std::istringstream in(text);
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    Line split{number, {}};
    std::istringstream words(line);
    for (std::string word; words >> word;) split.words.push_back(word.substr(0, 200));
    if (!split.words.empty()) lines.push_back(std::move(split));
  }
  return lines;
}

/// `PSB 1`, `<categories> <models>`, then per category `<name> <parent> <count>` and as many model numbers, a line each.
Result<void> read_cla(const fs::path& file, const std::map<std::string, ModelFile>& models, Classes& classes) {
  const auto text = read_file(file, kMaxListBytes);
  if (!text) return tl::unexpected(text.error());
  const std::vector<Line> lines = lines_of(*text);
  if (lines.size() < 2 || lines[0].words[0] != "PSB") return tl::unexpected(corrupt(file, 1, "expected 'PSB 1' and the numbers of categories and models"));
  for (std::size_t at = 2; at < lines.size();) {
    const Line& header = lines[at];
    std::size_t count = 0;
    const auto number = header.words.size() == 3 ? header.words[2] : std::string();
    const auto parsed = std::from_chars(number.data(), number.data() + number.size(), count);
    if (number.empty() || parsed.ec != std::errc{} || parsed.ptr != number.data() + number.size())
      return tl::unexpected(corrupt(file, header.number, "'" + header.words[0] + "...', expected a category: name, parent, number of models"));
    const std::string& name = header.words[0];
    if (!names_a_file(name)) return tl::unexpected(corrupt(file, header.number, "category '" + name + "', expected letters, digits, '_', '-' and '.'"));
    ++at;
    if (lines.size() - at < count)
      return tl::unexpected(corrupt(file, lines.back().number, name + " has " + std::to_string(lines.size() - at) + " models, expected " + std::to_string(count)));
    for (std::size_t k = 0; k < count; ++k, ++at)
      if (const auto model = models.find("m" + lines[at].words[0]); model != models.end()) classes[name].push_back(model->second);
  }
  return {};
}

Result<Classes> classes_of_table(const fs::path& root) {
  const auto entries = read_mesh_table(root / "meshes.csv");
  if (!entries) return tl::unexpected(entries.error());
  Classes classes;
  for (const MeshEntry& entry : *entries) {
    if (!names_a_file(entry.class_name)) return failure(ErrorCode::kCorruptData, (root / "meshes.csv").string() + ": class = '" + entry.class_name.substr(0, 100) + "', expected letters, digits, '_', '-' and '.'");
    if (entry.class_name != kNoClass) classes[entry.class_name].push_back({entry.file, root / entry.file, entry.scale_to_m, entry.up_axis});
  }
  return classes;
}

ModelFile model_file(const fs::path& root, const fs::path& file, const CollectionOptions& options) {
  return {file.lexically_relative(root).generic_string(), file, options.scale_to_m, options.up_axis};
}

Result<Classes> classes_of_lists(const fs::path& root, const std::vector<fs::path>& lists, const CollectionOptions& options) {
  std::map<std::string, ModelFile> models;
  for (const fs::path& file : files_below(root, is_mesh)) models[file.stem().string()] = model_file(root, file, options);
  Classes classes;
  for (const fs::path& list : lists)
    if (const auto read = read_cla(list, models, classes); !read) return tl::unexpected(read.error());
  return classes;
}

Classes classes_of_folders(const fs::path& root, const CollectionOptions& options) {
  Classes classes;
  std::error_code error;
  for (fs::directory_iterator entry(root, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (std::error_code ignored; !entry->is_directory(ignored) || !names_a_file(name)) continue;
    for (const fs::path& file : files_below(entry->path(), is_mesh)) classes[name].push_back(model_file(root, file, options));
  }
  return classes;
}

}  // namespace

Result<std::vector<ModelClass>> find_model_classes(const fs::path& root, const CollectionOptions& options) {
  std::error_code ignored;
  if (!fs::is_directory(root, ignored)) return failure(ErrorCode::kNotFound, root.string() + ": no such folder");
  const auto lists = files_below(root, [](const fs::path& file) { return file.extension() == ".cla"; });
  auto classes = fs::is_regular_file(root / "meshes.csv", ignored) ? classes_of_table(root)
                 : !lists.empty()                                  ? classes_of_lists(root, lists, options)
                                                                   : Result<Classes>(classes_of_folders(root, options));
  if (!classes) return tl::unexpected(classes.error());
  std::vector<ModelClass> found;
  for (auto& [name, files] : *classes) {
    const auto by_name = [](const ModelFile& a, const ModelFile& b) { return a.name < b.name; };
    std::sort(files.begin(), files.end(), by_name);
    files.erase(std::unique(files.begin(), files.end(), [](const ModelFile& a, const ModelFile& b) { return a.name == b.name; }), files.end());
    if (!files.empty()) found.push_back({name, std::move(files)});
  }
  if (found.empty()) return failure(ErrorCode::kNotFound, root.string() + ": no class, expected a meshes.csv, .cla lists, or folders with .off, .obj, .ply or .stl files");
  return found;
}

Result<std::vector<CollectionModel>> read_models(const ModelFile& file, double height_m) {
  MeshEntry entry{file.path.filename().string(), {}, file.scale_to_m, file.up_axis};
  if (height_m > 0) {  // about so large first, whatever the unit: which way is up is found at the object's scale
    const auto mesh = read_mesh(file.path);
    if (!mesh) return tl::unexpected(mesh.error());
    const double longest = mesh->vertices.empty() ? 1 : bounds(mesh->vertices).size().maxCoeff();
    if (longest > 0 && std::isfinite(longest)) entry.scale_to_m = height_m / longest;
  }
  auto objects = load_objects(file.path.parent_path(), entry);
  if (!objects) return tl::unexpected(objects.error());
  std::vector<CollectionModel> models;
  for (std::size_t k = 0; k < objects->size(); ++k) {
    bool turned = false;
    CollectionModel model{objects->size() > 1 ? file.name + " (" + std::to_string(k + 1) + ")" : file.name, on_origin(stood_up((*objects)[k], turned))};
    if (height_m > 0) {
      const double height = bounds(model.mesh.vertices).size().z();
      for (auto& v : model.mesh.vertices) v *= height > 0 ? height_m / height : 1;
    }
    models.push_back(std::move(model));
  }
  return models;
}

}  // namespace gfp
