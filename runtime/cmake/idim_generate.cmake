# idim_generate(TARGET <target> ROBOT <robot.yaml | robot.urdf> [LANGUAGE cpp|c] [COST ops|x86|mcu] [DERIVATIVES] [HEADERS_ONLY])
#
# Generates the models of a robot at build time, into the build tree, and adds them to a target. <robot> is the file's name without
# .yaml, <name> the name in the file.
#   LANGUAGE cpp (default): #include "<robot>/regressor.hpp", namespace idim_models::<name>; unless HEADERS_ONLY is given, also the
#     interface for the identifiers, extern "C" const idim_model_interface* idim_model_<robot>(void), and idim::runtime.
#   LANGUAGE c: #include "<robot>/<name>.h"; unless HEADERS_ONLY is given, also its sources, in double and single precision.
#   COST ops (default): the forms of the models are chosen for the fewest operations; x86, mcu: for such a processor.
#   DERIVATIVES: also <robot>/inverse_dynamics_derivatives, the derivatives of the inverse dynamics by positions and velocities.
# A change of the robot, of an effect or template, or of the generator regenerates; files that stay the same keep their times.
#
# The generator is the target idim::idim, or the program that IDIM_EXECUTABLE names: when cross-compiling, one that runs on the
# machine that builds.

# Files of a model in this language: those that its manifest.json will list.
function(_idim_model_files language name derivatives result)
  set(models regressor inverse_dynamics mass_matrix bias gravity forward_dynamics regroup sines)
  if(derivatives)
    list(APPEND models inverse_dynamics_derivatives)
  endif()
  if(language STREQUAL c)
    list(TRANSFORM models APPEND ".c" OUTPUT_VARIABLE in_double)
    list(TRANSFORM models APPEND "_f.c" OUTPUT_VARIABLE in_float)
    set(${result} ${in_double} ${in_float} tables.c ${name}.h PARENT_SCOPE)
  else()
    list(TRANSFORM models APPEND ".hpp" OUTPUT_VARIABLE headers)
    set(${result} ${headers} batch.hpp functions.hpp model.hpp pack.hpp model_interface.cpp PARENT_SCOPE)
  endif()
endfunction()

# The name of a robot as the generator reads it from a URDF: a C identifier, with an underscore behind a name that means something
# in generated code.
function(_idim_identifier text result)
  set(language_names
    alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t char32_t class compl
    concept const consteval constexpr constinit const_cast continue co_await co_return co_yield decltype default delete do
    double dynamic_cast else enum explicit export extern false float for friend goto if inline int long mutable namespace
    new noexcept not not_eq nullptr operator or or_eq private protected public register requires return short signed
    sizeof static static_assert static_cast reinterpret_cast struct switch template this thread_local throw true try
    typedef typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq restrict main std idim
    assert errno NULL EOF NAN INFINITY linux unix base)
  string(REGEX REPLACE "[^A-Za-z0-9]" "_" identifier "${text}")
  string(REGEX REPLACE "^([^A-Za-z])" "r\\1" identifier "${identifier}")
  if(identifier IN_LIST language_names)
    string(APPEND identifier "_")
  endif()
  set(${result} "${identifier}" PARENT_SCOPE)
endfunction()

# The name in the file, and the URDF that its line `urdf:` names, if any. Read when the build is configured: once more when the
# file changes.
function(_idim_read_robot robot_file name urdf_file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${robot_file}")
  file(READ "${robot_file}" text LIMIT 65536)
  set(${urdf_file} "" PARENT_SCOPE)
  if(robot_file MATCHES "\\.urdf$")
    string(REGEX MATCH "<robot[^>]*[ \t\n]name[ \t\n]*=[ \t\n]*[\"']([^\"']*)" found "${text}")
  else()
    if("\n${text}" MATCHES "\nurdf:[ \t]*[\"']?([^\"'#\n]*[^\"'# \t\n])")
      get_filename_component(folder "${robot_file}" DIRECTORY)
      get_filename_component(urdf "${CMAKE_MATCH_1}" ABSOLUTE BASE_DIR "${folder}")
      set(${urdf_file} "${urdf}" PARENT_SCOPE)
    endif()
    string(REGEX MATCH "\nname:[ \t]*[\"']?([A-Za-z0-9_]*)" found "\n${text}")
  endif()
  _idim_identifier("${CMAKE_MATCH_1}" identifier)
  set(${name} "${identifier}" PARENT_SCOPE)
endfunction()

# The program that generates: a path or a generator expression, either of which may be a dependency.
function(_idim_generator result)
  get_target_property(installed idim::idim IMPORTED)
  if(IDIM_EXECUTABLE)
    set(${result} "${IDIM_EXECUTABLE}" PARENT_SCOPE)
  elseif(CMAKE_CROSSCOMPILING AND NOT installed)
    message(FATAL_ERROR "idim_generate: cross-compiling needs a generator for this machine, set IDIM_EXECUTABLE to one")
  else()
    set(${result} "$<TARGET_FILE:idim::idim>" PARENT_SCOPE)
  endif()
endfunction()

# One custom target for a robot and language, whatever number of targets use it: it keeps where the files stand and which they are.
function(_idim_add_model target robot_file language cost derivatives folder)
  _idim_generator(generator)
  _idim_read_robot("${robot_file}" name urdf_file)
  _idim_model_files(${language} "${name}" ${derivatives} files)
  list(TRANSFORM files PREPEND "${folder}/")
  get_filename_component(robot_folder "${robot_file}" DIRECTORY)
  get_property(templates GLOBAL PROPERTY IDIM_TEMPLATES)
  file(GLOB inputs CONFIGURE_DEPENDS "${templates}/${language}/*" "${templates}/effects/*" "${robot_folder}/*.yaml"
       "${robot_folder}/effects/*.yaml")
  add_custom_command(
    OUTPUT "${folder}/generated.stamp"
    BYPRODUCTS ${files}
    COMMAND "${generator}" generate "${robot_file}" -o "${folder}" --target ${language} --cost ${cost}
            "$<$<BOOL:${derivatives}>:--derivatives>"
    COMMAND ${CMAKE_COMMAND} -E touch "${folder}/generated.stamp"
    DEPENDS "${generator}" "${robot_file}" ${urdf_file} ${inputs}
    COMMENT "idim: models of ${name}"
    COMMAND_EXPAND_LISTS VERBATIM)
  add_custom_target(${target} DEPENDS "${folder}/generated.stamp")
  set_target_properties(${target} PROPERTIES IDIM_ROBOT "${robot_file}" IDIM_COST ${cost} IDIM_DERIVATIVES ${derivatives}
                                             IDIM_FOLDER "${folder}" IDIM_FILES "${files}")
endfunction()

function(idim_generate)
  cmake_parse_arguments(ARG "HEADERS_ONLY;DERIVATIVES" "TARGET;ROBOT;LANGUAGE;COST" "" ${ARGN})
  if(NOT ARG_LANGUAGE)
    set(ARG_LANGUAGE cpp)
  endif()
  if(NOT ARG_COST)
    set(ARG_COST ops)
  endif()
  if(NOT ARG_TARGET OR NOT ARG_ROBOT OR NOT ARG_LANGUAGE MATCHES "^(cpp|c)$" OR NOT ARG_COST MATCHES "^(ops|x86|mcu)$"
     OR ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "idim_generate: expected TARGET <target> ROBOT <robot.yaml | robot.urdf> [LANGUAGE cpp|c] "
                        "[COST ops|x86|mcu] [DERIVATIVES] [HEADERS_ONLY], got: ${ARGN}")
  endif()
  if(NOT TARGET ${ARG_TARGET})
    message(FATAL_ERROR "idim_generate: no target ${ARG_TARGET}")
  endif()
  get_filename_component(robot_file "${ARG_ROBOT}" ABSOLUTE)
  if(NOT EXISTS "${robot_file}")
    message(FATAL_ERROR "idim_generate: no file ${robot_file}")
  endif()
  get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
  if(ARG_LANGUAGE STREQUAL c AND NOT "C" IN_LIST languages)
    message(FATAL_ERROR "idim_generate: LANGUAGE c needs a project with C among its LANGUAGES")
  endif()
  get_filename_component(robot "${robot_file}" NAME_WLE)
  string(MAKE_C_IDENTIFIER "${robot}" identifier)

  set(models idim_generate_${ARG_LANGUAGE}_${identifier})
  if(NOT TARGET ${models})
    _idim_add_model(${models} "${robot_file}" ${ARG_LANGUAGE} ${ARG_COST} ${ARG_DERIVATIVES}
                    "${CMAKE_CURRENT_BINARY_DIR}/idim_models/${ARG_LANGUAGE}/${robot}")
  endif()
  get_target_property(same_robot ${models} IDIM_ROBOT)
  if(NOT same_robot STREQUAL robot_file)
    message(FATAL_ERROR "idim_generate: two robots called ${robot}: ${same_robot} and ${robot_file}")
  endif()
  get_target_property(same_cost ${models} IDIM_COST)
  if(NOT same_cost STREQUAL ARG_COST)
    message(FATAL_ERROR "idim_generate: ${robot} with COST ${same_cost} and COST ${ARG_COST}, expected one for a robot and language")
  endif()
  get_target_property(has_derivatives ${models} IDIM_DERIVATIVES)
  if(ARG_DERIVATIVES AND NOT has_derivatives)
    message(FATAL_ERROR "idim_generate: the first call for ${robot} in this language has no DERIVATIVES, give it there")
  endif()
  get_target_property(folder ${models} IDIM_FOLDER)
  get_filename_component(root "${folder}" DIRECTORY)
  add_dependencies(${ARG_TARGET} ${models})
  target_include_directories(${ARG_TARGET} PRIVATE "${root}")

  if(ARG_LANGUAGE STREQUAL cpp)
    target_compile_features(${ARG_TARGET} PRIVATE cxx_std_17)
  endif()
  if(ARG_HEADERS_ONLY)
    return()
  endif()
  get_target_property(sources ${models} IDIM_FILES)
  list(FILTER sources INCLUDE REGEX "\\.(c|cpp)$")
  # Files of a model, or of two, define functions of the same names for themselves: no unit joins them.
  set_source_files_properties(${sources} PROPERTIES GENERATED TRUE SKIP_UNITY_BUILD_INCLUSION TRUE)
  target_sources(${ARG_TARGET} PRIVATE ${sources})
  if(ARG_LANGUAGE STREQUAL c)
    target_compile_features(${ARG_TARGET} PRIVATE c_std_99)
    target_link_libraries(${ARG_TARGET} PRIVATE m)
  elseif(TARGET idim::runtime)
    set_source_files_properties(${sources} PROPERTIES COMPILE_DEFINITIONS "IDIM_MODEL_SYMBOL=idim_model_${identifier}")
    target_link_libraries(${ARG_TARGET} PRIVATE idim::runtime)
  else()
    message(FATAL_ERROR "idim_generate: the interface for the identifiers needs idim::runtime, which is not here; "
                        "find_package(idim COMPONENTS runtime), or HEADERS_ONLY")
  endif()
endfunction()
