# INCISE_PYTHON: the interpreter of the distribution, whose packages (numpy, pybind11) are the ones that we name; else the first found.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that runs the tests and for which the module is built")
endif()
find_package(Python 3.9 REQUIRED COMPONENTS Interpreter)
set(INCISE_PYTHON ${Python_EXECUTABLE})
