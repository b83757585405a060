# SPDX-License-Identifier: BSD-3-Clause
# Reads the tables of settings, and makes from them what needs them. A program that includes this has, for each setting
# NAME, the variables DSM_NAME_LABEL and so on, and all names in DSM_SETTINGS.
#
# dsm_setting(NAME OWNER owner TYPE type ... TEXT tooltip)
#   OWNER    scene: one value for all that a view shows; ranks: one for all views; dataset: each has its own;
#            voxels, volume, slices, mesh: a property of displays of volumes, of those as DSM Volume or DSM Slices only,
#            or of meshes
#   METHOD   Set<METHOD> in C++ (Select<METHOD> in displays, of an array); NAME by default. The property is DSM<NAME>.
#            Of numbers: Add<METHOD>, RemoveAll<METHOD>s and Get<METHOD>s.
#   TYPE     bool, int, double, enum, directory, range (two numbers), numbers (any number of them) or array (its name)
#   DEFAULT  value
#   RANGE    least and greatest valid number; without the second, unlimited
#   SLIDER   range of the panel's slider, where it has one
#   CHOICES  numbers that the panel's slider offers instead
#   ENTRIES  of an enum: a name in C++ and a text for each value from 0
#   ARRAYS   of an array: domain of the display's Input that has the arrays to choose from
#   WHEN     conditions, all of which must hold for the panel to show it; ENABLED: for it to be enabled. See dsm_when.
#   PANEL    first: below Representation; default or advanced: in the group Ray Tracing. Without: not in the panel.
#            Properties of displays are default or advanced.
#   GROUP    of properties of displays: cut for Cut Faces. Without: below Representation (voxels), or the owner's own.
#   ZERO     what the value 0 means, on the settings page
#   PAGE_DEFAULT, PAGE_ENTRIES  of what is no setting of the ranks, but on the settings page: default, number of entries
#   OWN_METHOD  the class of the display has the method itself; else it is the mapper's, which displays forward to
#   DETAILS  what the method's comment says beside TEXT
set(DSM_SETTINGS)
function (dsm_setting name)
  set(keys OWNER METHOD TYPE DEFAULT LABEL PANEL GROUP ARRAYS ZERO PAGE_DEFAULT PAGE_ENTRIES CHOICES TEXT DETAILS)
  set(lists RANGE SLIDER ENTRIES WHEN ENABLED)
  cmake_parse_arguments(PARSE_ARGV 1 arg "OWN_METHOD" "${keys}" "${lists}")
  if (NOT arg_METHOD)
    set(arg_METHOD "${name}")
  endif ()
  if (NOT arg_GROUP)
    set(arg_GROUP "${arg_OWNER}")
  endif ()
  if (arg_TEXT MATCHES ";" OR arg_UNPARSED_ARGUMENTS
      OR NOT arg_OWNER MATCHES "^(scene|ranks|dataset|voxels|volume|slices|mesh)$")
    message(FATAL_ERROR "Setting ${name}: the text has a semicolon, or a word or the owner is unknown.")
  endif ()
  string(REGEX REPLACE "[ \n]+" " " arg_TEXT "${arg_TEXT}")
  string(REGEX REPLACE "[ \n]+" " " arg_DETAILS "${arg_DETAILS}")
  foreach (key IN LISTS keys lists ITEMS OWN_METHOD)
    set(DSM_${name}_${key} "${arg_${key}}" PARENT_SCOPE)
  endforeach ()
  set(DSM_SETTINGS ${DSM_SETTINGS} ${name} PARENT_SCOPE)
endfunction ()
foreach (table IN ITEMS options/settings mapper/properties)
  include("${PROJECT_SOURCE_DIR}/vtk_modules/RenderingDSM/${table}.cmake")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
    "${PROJECT_SOURCE_DIR}/vtk_modules/RenderingDSM/${table}.cmake")
endforeach ()

# Names of the settings that owners have, in the tables' order; without those whose methods are written by hand.
function (dsm_settings_of result)
  set(names)
  foreach (name IN LISTS DSM_SETTINGS)
    if (DSM_${name}_OWNER IN_LIST ARGN AND NOT DSM_${name}_OWN_METHOD)
      list(APPEND names ${name})
    endif ()
  endforeach ()
  set(${result} ${names} PARENT_SCOPE)
endfunction ()

# Makes the variables argument, member and kept of a setting: its types in C++, and the valid value of `value`. Numbers
# that have a range have the variables least and most.
macro (dsm_describe_in_cxx name)
  set(argument "${DSM_${name}_TYPE}")
  set(kept "value")
  set(least "")
  set(most "")
  if (argument STREQUAL "directory")
    set(argument "const char*")
    set(kept "value ? value : \"\"")
  elseif (argument STREQUAL "array")
    set(argument std::string)
  elseif (DSM_${name}_ENTRIES)
    set(argument int)
    list(LENGTH DSM_${name}_ENTRIES most)
    math(EXPR most "${most} / 2 - 1")
    set(least 0)
  elseif (NOT "${DSM_${name}_RANGE}" STREQUAL "")
    string(TOUPPER "VTK_${argument}_MAX" most)
    list(GET DSM_${name}_RANGE 0 least)
    list(LENGTH DSM_${name}_RANGE length)
    if (length GREATER 1)
      list(GET DSM_${name}_RANGE 1 most)
    endif ()
  endif ()
  if (NOT least STREQUAL "")
    set(kept "std::clamp<${argument}>(value, ${least}, ${most})")
  endif ()
  string(REPLACE "const char*" "std::string" member "${argument}")
endmacro ()

# The declaration of a setting's enumeration. Empty if it has none.
function (dsm_enumerate result name type)
  set(constants "")
  set(entries "${DSM_${name}_ENTRIES}")
  while (entries)
    list(POP_FRONT entries constant text)
    string(APPEND constants "    ${constant}, ///< ${text}\n")
  endwhile ()
  if (constants)
    set(constants "  enum ${type}\n  {\n${constants}  };\n")
  endif ()
  set(${result} "${constants}" PARENT_SCOPE)
endfunction ()

# Writes the sources of vtkDSM<kind>Options and adds them to the variables headers and sources.
function (dsm_write_options DSM_KIND DSM_BRIEF DSM_DETAILS)
  foreach (part IN ITEMS DECLARATIONS DEFINITIONS MEMBERS HANDED_OVER PRINTED)
    set(DSM_${part} "")
  endforeach ()
  set(class "vtkDSM${DSM_KIND}Options")
  dsm_settings_of(names ${ARGN})
  foreach (name IN LISTS names)
    dsm_describe_in_cxx(${name})
    set(method "${DSM_${name}_METHOD}")
    set(default "{ ${DSM_${name}_DEFAULT} }")
    string(REPLACE "{  }" "{}" default "${default}")
    dsm_enumerate(other ${name} ${name}Type)
    if (argument STREQUAL "bool")
      set(other "  vtkBooleanMacro(${method}, bool);\n")
    endif ()
    string(APPEND DSM_DECLARATIONS "\n  ///@{\n  /**\n   * ${DSM_${name}_TEXT}\n   */\n"
      "${other}  virtual void Set${method}(${argument} value);\n"
      "  virtual ${argument} Get${method}() const;\n  ///@}\n")
    string(APPEND DSM_MEMBERS "  ${member} ${method}${default};\n")
    set(forwarded "")
    if (NOT DSM_${name}_OWNER STREQUAL "dataset")
      set(forwarded "  for (const auto& owner : this->Owners)
  {
    if (owner)
    {
      owner->Set${method}(value);
    }
  }\n")
      string(APPEND DSM_HANDED_OVER "  if (this->${method} != ${member}${default})
  {
    owner->Set${method}(this->Get${method}());
  }\n")
    endif ()
    set(value "this->${method}")
    if (NOT argument STREQUAL member)
      string(APPEND value ".c_str()")
    endif ()
    string(APPEND DSM_DEFINITIONS "
void ${class}::Set${method}(${argument} value)
{
  const ${member} kept = ${kept};
  if (this->${method} != kept)
  {
    this->${method} = kept;
    this->Modified();
  }
${forwarded}}

${argument} ${class}::Get${method}() const
{
  return ${value};
}\n")
    string(APPEND DSM_PRINTED "  os << indent << \"${method}: \" << this->${method} << \"\\n\";\n")
  endforeach ()
  foreach (suffix IN ITEMS h cxx)
    configure_file(options/vtkDSMOptions.${suffix}.in "${CMAKE_CURRENT_BINARY_DIR}/${class}.${suffix}" @ONLY)
  endforeach ()
  set(headers ${headers} "${CMAKE_CURRENT_BINARY_DIR}/${class}.h" PARENT_SCOPE)
  set(sources ${sources} "${CMAKE_CURRENT_BINARY_DIR}/${class}.cxx" PARENT_SCOPE)
endfunction ()

# Writes the header of vtkDSM<kind>DisplayMapper, the base class of a mapper with the methods of owners' properties, and
# adds it to the variable headers.
function (dsm_write_display_mapper DSM_KIND DSM_SUPERCLASS)
  foreach (part IN ITEMS DECLARATIONS MEMBERS COPIED PRINTED)
    set(DSM_${part} "")
  endforeach ()
  dsm_settings_of(names ${ARGN})
  foreach (name IN LISTS names)
    dsm_describe_in_cxx(${name})
    set(method "${DSM_${name}_METHOD}")
    set(members ${method})
    set(set "vtkSetMacro(${method}, ${argument});")
    set(get "vtkGetMacro(${method}, ${argument});")
    set(member "${argument} ${method}{ ${DSM_${name}_DEFAULT} };")
    if (DSM_${name}_TYPE STREQUAL "range")
      set(set "vtkSetVector2Macro(${method}, double);")
      set(get "vtkGetVector2Macro(${method}, double);")
      string(REPLACE " " ", " default "${DSM_${name}_DEFAULT}")
      set(member "double ${method}[2] = { ${default} };")
    elseif (DSM_${name}_TYPE STREQUAL "array")
      if (NOT DSM_${name}_ARRAYS MATCHES "point")
        list(APPEND members ${method}OnCells)
        string(APPEND get "\n  vtkSetMacro(${method}OnCells, bool);\n  vtkGetMacro(${method}OnCells, bool);")
        string(APPEND member "\n  bool ${method}OnCells = false;")
      endif ()
    elseif (argument STREQUAL "bool")
      string(APPEND get "\n  vtkBooleanMacro(${method}, bool);")
    elseif (NOT least STREQUAL "")
      set(set "vtkSetClampMacro(${method}, ${argument}, ${least}, ${most});")
    endif ()
    if (DSM_${name}_TYPE STREQUAL "numbers")
      set(set "void Add${method}(double value)
  {
    this->${method}s.push_back(value);
    this->Modified();
  }
  void RemoveAll${method}s()
  {
    this->${method}s.clear();
    this->Modified();
  }")
      set(get "const std::vector<double>& Get${method}s() const { return this->${method}s; }")
      set(member "std::vector<double> ${method}s;")
      set(members)
      string(APPEND DSM_COPIED "      this->${method}s = other->${method}s;\n      this->Modified();\n")
      string(APPEND DSM_PRINTED "    os << indent << \"${method}s:\";\n    for (const double value : this->${method}s)
    {\n      os << \" \" << value;\n    }\n    os << \"\\n\";\n")
    endif ()
    dsm_enumerate(enum ${name} ${name}s)
    string(STRIP "${DSM_${name}_TEXT} ${DSM_${name}_DETAILS}" text)
    string(APPEND DSM_DECLARATIONS "\n  ///@{\n  /**\n   * ${text}\n   */\n"
      "${enum}  ${set}\n  ${get}\n  ///@}\n")
    string(APPEND DSM_MEMBERS "  ${member}\n")
    foreach (member IN LISTS members)
      string(APPEND DSM_COPIED "      this->Set${member}(other->${member});\n")
      set(value "this->${member}")
      if (DSM_${name}_TYPE STREQUAL "range")
        set(value "${value}[0] << \" \" << ${value}[1]")
      endif ()
      string(APPEND DSM_PRINTED "    os << indent << \"${member}: \" << ${value} << \"\\n\";\n")
    endforeach ()
  endforeach ()
  set(header "${CMAKE_CURRENT_BINARY_DIR}/vtkDSM${DSM_KIND}DisplayMapper.h")
  configure_file(mapper/vtkDSMDisplayMapper.h.in "${header}" @ONLY)
  set(headers ${headers} "${header}" PARENT_SCOPE)
endfunction ()

# Writes the header of vtkPVDSM<kind>Display, the base class of a display, with methods that set owners' properties of
# its mapper, and adds it to the variable headers.
function (dsm_write_display DSM_KIND DSM_SUPERCLASS)
  set(DSM_METHODS "")
  set(mapper "this->Get${DSM_KIND}Mapper()")
  dsm_settings_of(names ${ARGN})
  foreach (name IN LISTS names)
    dsm_describe_in_cxx(${name})
    set(method "Set${DSM_${name}_METHOD}")
    set(setter "${method}")
    set(parameters "${argument} value")
    set(effect "${mapper}->${method}(value);")
    if (DSM_${name}_TYPE STREQUAL "range")
      set(parameters "double least, double most")
      set(effect "${mapper}->${method}(least, most);")
    elseif (DSM_${name}_TYPE STREQUAL "array")
      # "None" is the word that the panel offers beside the arrays.
      set(setter "Select${DSM_${name}_METHOD}")
      set(association "")
      set(effect "${mapper}->${method}(name && std::strcmp(name, \"None\") != 0 ? name : \"\");")
      if (NOT DSM_${name}_ARRAYS MATCHES "point")
        set(association " association")
        string(APPEND effect
          "\n    ${mapper}->${method}OnCells(association == vtkDataObject::FIELD_ASSOCIATION_CELLS);")
      endif ()
      set(parameters "int, int, int, int${association}, const char* name")
    elseif (DSM_${name}_TYPE STREQUAL "numbers")
      set(setter "Add${DSM_${name}_METHOD}")
      set(parameters "double value")
      set(effect "${mapper}->${setter}(value);")
      set(remover "RemoveAll${DSM_${name}_METHOD}s")
      string(APPEND DSM_METHODS "  void ${remover}()\n  {\n    ${mapper}->${remover}();\n  }\n")
    endif ()
    string(APPEND DSM_METHODS "  void ${setter}(${parameters})\n  {\n    ${effect}\n  }\n")
  endforeach ()
  set(header "${CMAKE_CURRENT_BINARY_DIR}/vtkPVDSM${DSM_KIND}Display.h")
  configure_file(displays/vtkPVDSMDisplay.h.in "${header}" @ONLY)
  set(headers ${headers} "${header}" PARENT_SCOPE)
endfunction ()

# Writes the sources of vtkPVDSM<kind>Options, likewise: the methods that ParaView calls, which knows those of the
# plugin's own classes only, and says where numbers are out of range. Other arguments as of dsm_write_options.
function (dsm_write_paraview_options DSM_KIND)
  set(DSM_DECLARATIONS "")
  set(DSM_DEFINITIONS "")
  set(class "vtkPVDSM${DSM_KIND}Options")
  dsm_settings_of(names ${ARGN})
  foreach (name IN LISTS names)
    dsm_describe_in_cxx(${name})
    set(method "Set${DSM_${name}_METHOD}")
    string(APPEND DSM_DECLARATIONS "  void ${method}(${argument} value) override;\n")
    if (least STREQUAL "")
      set(kept "value")
    else ()
      set(kept "vtkPVDSMSettingRange::Keep<${argument}>(this, \"DSM${name}\", value, ${least}, ${most})")
    endif ()
    string(APPEND DSM_DEFINITIONS "\nvoid ${class}::${method}(${argument} value)\n{\n"
      "  this->Superclass::${method}(${kept});\n}\n")
    if (DSM_${name}_CHOICES)
      # ParaView's slider of choices is for floating point numbers only.
      string(APPEND DSM_DECLARATIONS "  void ${method}Choice(double value);\n")
      string(APPEND DSM_DEFINITIONS "\nvoid ${class}::${method}Choice(double value)\n{\n"
        "  this->${method}(vtkMath::Round(value));\n}\n")
    endif ()
  endforeach ()
  foreach (suffix IN ITEMS h cxx)
    configure_file(settings/vtkPVDSMOptions.${suffix}.in "${CMAKE_CURRENT_BINARY_DIR}/${class}.${suffix}" @ONLY)
  endforeach ()
  set(headers ${headers} "${CMAKE_CURRENT_BINARY_DIR}/${class}.h" PARENT_SCOPE)
  set(sources ${sources} "${CMAKE_CURRENT_BINARY_DIR}/${class}.cxx" PARENT_SCOPE)
endfunction ()

# dsm_counter(NAME UNIT unit VALUE expression ... TEXT description)
#   UNIT      Count, Bytes or Seconds
#   VALUE     in C++, in vtkDSMStatistics::Gather
#   WORKER    likewise, of one thread; those without are counted for the rank only
#   COLUMN    title in the panel; WITH another counter, which is added; COLUMN_TEXT: what it says, instead of TEXT
#   NO_TOTAL  the panel does not add up the ranks' values
# Makes lists in C++ of the counters of ranks and workers, and of the panel's columns, as DSMCounters.h has them, and
# rows of the table in the documents (DSM_COUNTER_ROWS).
macro (dsm_counter name)
  cmake_parse_arguments(arg "NO_TOTAL" "UNIT;VALUE;WORKER;COLUMN;WITH;COLUMN_TEXT;TEXT" "" ${ARGN})
  string(TOLOWER "${arg_UNIT}" unit)
  set(type std::int64_t)
  if (arg_UNIT STREQUAL "Seconds")
    set(type double)
  endif ()
  string(APPEND DSM_RANK_COUNTERS " \\\n  use(${type}, ${name}, ${arg_VALUE})")
  if (arg_WORKER)
    string(APPEND DSM_WORKER_COUNTERS " \\\n  use(${type}, ${name}, ${arg_WORKER})")
  endif ()
  if (arg_COLUMN)
    string(REPLACE TRUE false total "${arg_NO_TOTAL}")
    string(REPLACE FALSE true total "${total}")
    set(keys "\"${name}\"")
    if (arg_WITH)
      string(APPEND keys ", \"${arg_WITH}\"")
    endif ()
    if (NOT arg_COLUMN_TEXT)
      set(arg_COLUMN_TEXT "${arg_TEXT}")
    endif ()
    string(APPEND DSM_PANEL_COLUMNS " \\\n  use(\"${arg_COLUMN}\", Unit::${arg_UNIT}, ${total},"
      " \"${arg_COLUMN_TEXT}\", ${keys})")
  endif ()
  string(APPEND DSM_COUNTER_ROWS "| `${name}` | ${unit} | ${arg_COLUMN} | ${arg_TEXT} |\n")
endmacro ()
include("${PROJECT_SOURCE_DIR}/vtk_modules/RenderingDSM/frame/counters.cmake")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
  "${PROJECT_SOURCE_DIR}/vtk_modules/RenderingDSM/frame/counters.cmake")

# Writes docs/properties.md, from its template, to a file, except for the rows that tests/docs/make_properties.py adds
# from xml/.
function (dsm_write_properties_document file)
  dsm_settings_of(names scene ranks dataset)
  foreach (name IN LISTS names)
    string(TOUPPER "${DSM_${name}_OWNER}" owner)
    set(default "`${DSM_${name}_DEFAULT}`")
    set(values "")
    if (DSM_${name}_ENTRIES)
      set(entries ${DSM_${name}_ENTRIES})
      while (entries)
        list(POP_FRONT entries constant text)
        list(APPEND values "`\"${text}\"`")
      endwhile ()
      list(GET values ${DSM_${name}_DEFAULT} default)
      list(JOIN values ", " values)
    elseif (DSM_${name}_TYPE STREQUAL "bool")
      set(values "0, 1")
    elseif (DSM_${name}_TYPE STREQUAL "directory")
      set(values "path")
      set(default "empty")
    else ()
      list(JOIN DSM_${name}_RANGE " to " values)
      if (NOT values MATCHES "to")
        string(APPEND values " or more")
      endif ()
    endif ()
    string(APPEND DSM_${owner}_ROWS "| ${DSM_${name}_LABEL} | `DSM${name}` | `Set${DSM_${name}_METHOD}` | ${default} |"
      " ${values} | ${DSM_${name}_TEXT} |\n")
  endforeach ()
  configure_file("${PROJECT_SOURCE_DIR}/docs/properties.md.in" "${file}" @ONLY)
endfunction ()
