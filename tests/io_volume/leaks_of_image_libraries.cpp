// Leaks inside the image libraries, found with the leak sanitizer when files are refused or written; none of them
// starts in our code. Read by the sanitizer's run-time library only, which looks for a function of this name.
extern "C" const char* __lsan_default_suppressions();

extern "C" const char* __lsan_default_suppressions() {
  return "leak:libITKniftiio\n"
         "leak:libITKNrrdIO\n"
         "leak:libopenjp2\n"
         "leak:libgdcmMSFF\n";
}
