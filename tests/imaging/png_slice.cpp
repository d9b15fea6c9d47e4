#include "imaging/png_slice.hpp"

#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkPNGImageIO.h>

namespace incise::testing {

PngSlice read_png_slice(const std::filesystem::path& file) {
  using Picture = itk::Image<unsigned char, 2>;
  auto reader = itk::ImageFileReader<Picture>::New();
  reader->SetImageIO(itk::PNGImageIO::New());
  reader->SetFileName(file.string());
  reader->Update();
  const auto size = reader->GetOutput()->GetLargestPossibleRegion().GetSize();
  const unsigned char* first = reader->GetOutput()->GetBufferPointer();
  return {static_cast<int>(size[0]), static_cast<int>(size[1]), {first, first + size[0] * size[1]}};
}

}  // namespace incise::testing
