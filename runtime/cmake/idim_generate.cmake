# idim_generate(TARGET <target> ROBOT <robot.yaml | robot.urdf> [HEADERS_ONLY])
#
# Generates the models of a robot at build time, into the build tree, and adds them to a target:
#   #include "<robot>/regressor.hpp"     (<robot> is the file's name without .yaml; namespace idim_models::<name in the file>)
# and, unless HEADERS_ONLY is given, the interface for the identifiers, whose accessor is
#   extern "C" const idim_model_interface* idim_model_<robot>(void);
# A change of the robot, of an effect or template, or of the generator regenerates; files that stay the same keep their times.
#
# The generator is the target idim::idim, or the program that IDIM_EXECUTABLE names: when cross-compiling, one that runs on the
# machine that builds.

# Files of a model in this folder: those that its manifest.json will list.
function(_idim_model_files folder result)
  set(files regressor.hpp inverse_dynamics.hpp mass_matrix.hpp bias.hpp gravity.hpp forward_dynamics.hpp regroup.hpp
            functions.hpp model.hpp model_interface.cpp)
  list(TRANSFORM files PREPEND "${folder}/")
  set(${result} ${files} PARENT_SCOPE)
endfunction()

# What a model is made from, beside the generator: the description, the file that its line `urdf:` names, effects and templates.
function(_idim_inputs robot_file result)
  get_filename_component(folder "${robot_file}" DIRECTORY)
  get_property(templates GLOBAL PROPERTY IDIM_TEMPLATES)
  file(GLOB inputs CONFIGURE_DEPENDS "${templates}/*/*" "${folder}/*.yaml" "${folder}/effects/*.yaml")
  if(NOT robot_file MATCHES "\\.urdf$")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${robot_file}")
    file(STRINGS "${robot_file}" urdf REGEX "^urdf:")
    if(urdf MATCHES "^urdf:[ \t]*[\"']?([^\"'#]*[^\"'# \t])")
      get_filename_component(urdf_file "${CMAKE_MATCH_1}" ABSOLUTE BASE_DIR "${folder}")
      list(APPEND inputs "${urdf_file}")
    endif()
  endif()
  set(${result} "${robot_file}" ${inputs} PARENT_SCOPE)
endfunction()

# One custom target for a robot, whatever number of targets use it: it keeps where the models stand.
function(_idim_add_model target robot_file folder)
  get_target_property(installed idim::idim IMPORTED)
  if(IDIM_EXECUTABLE)
    set(generator "${IDIM_EXECUTABLE}")
  elseif(CMAKE_CROSSCOMPILING AND NOT installed)
    message(FATAL_ERROR "idim_generate: cross-compiling needs a generator for this machine, set IDIM_EXECUTABLE to one")
  else()
    set(generator "$<TARGET_FILE:idim::idim>")
  endif()
  _idim_inputs("${robot_file}" inputs)
  _idim_model_files("${folder}" files)
  get_filename_component(robot "${folder}" NAME)
  add_custom_command(
    OUTPUT "${folder}/generated.stamp"
    BYPRODUCTS ${files}
    COMMAND "${generator}" generate "${robot_file}" -o "${folder}"
    COMMAND ${CMAKE_COMMAND} -E touch "${folder}/generated.stamp"
    DEPENDS "${generator}" ${inputs}
    COMMENT "idim: models of ${robot}"
    VERBATIM)
  add_custom_target(${target} DEPENDS "${folder}/generated.stamp")
  set_target_properties(${target} PROPERTIES IDIM_ROBOT "${robot_file}" IDIM_FOLDER "${folder}")
endfunction()

function(idim_generate)
  cmake_parse_arguments(ARG "HEADERS_ONLY" "TARGET;ROBOT" "" ${ARGN})
  if(NOT ARG_TARGET OR NOT ARG_ROBOT OR ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "idim_generate: expected TARGET <target> ROBOT <robot.yaml> [HEADERS_ONLY], got: ${ARGN}")
  endif()
  if(NOT TARGET ${ARG_TARGET})
    message(FATAL_ERROR "idim_generate: no target ${ARG_TARGET}")
  endif()
  get_filename_component(robot_file "${ARG_ROBOT}" ABSOLUTE)
  if(NOT EXISTS "${robot_file}")
    message(FATAL_ERROR "idim_generate: no file ${robot_file}")
  endif()
  get_filename_component(robot "${robot_file}" NAME_WLE)
  string(MAKE_C_IDENTIFIER "${robot}" identifier)

  set(models idim_generate_${identifier})
  if(NOT TARGET ${models})
    set(new_folder "${CMAKE_CURRENT_BINARY_DIR}/idim_models/${robot}")
    _idim_add_model(${models} "${robot_file}" "${new_folder}")
  endif()
  get_target_property(same_robot ${models} IDIM_ROBOT)
  if(NOT same_robot STREQUAL robot_file)
    message(FATAL_ERROR "idim_generate: two robots called ${robot}: ${same_robot} and ${robot_file}")
  endif()

  get_target_property(folder ${models} IDIM_FOLDER)
  get_filename_component(root "${folder}" DIRECTORY)
  add_dependencies(${ARG_TARGET} ${models})
  target_include_directories(${ARG_TARGET} PRIVATE "${root}")
  target_compile_features(${ARG_TARGET} PRIVATE cxx_std_17)
  if(NOT ARG_HEADERS_ONLY)
    if(NOT TARGET idim::runtime)
      message(FATAL_ERROR "idim_generate: the interface for the identifiers needs idim::runtime, which is not here; "
                          "find_package(idim COMPONENTS runtime), or HEADERS_ONLY")
    endif()
    set_source_files_properties("${folder}/model_interface.cpp" PROPERTIES GENERATED TRUE
                                COMPILE_DEFINITIONS "IDIM_MODEL_SYMBOL=idim_model_${identifier}")
    target_sources(${ARG_TARGET} PRIVATE "${folder}/model_interface.cpp")
    target_link_libraries(${ARG_TARGET} PRIVATE idim::runtime)
  endif()
endfunction()
