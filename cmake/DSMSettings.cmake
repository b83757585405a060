# SPDX-License-Identifier: BSD-3-Clause
# Reads the table of settings, and makes from it what needs them. A program that includes this has, for each setting
# NAME, the variables DSM_NAME_LABEL and so on, and all names in DSM_SETTINGS.
#
# dsm_setting(NAME OWNER owner TYPE type ... TEXT tooltip)
#   OWNER    scene: one value for all that a view shows; ranks: one for all views; dataset: each has its own
#   METHOD   Set<METHOD> in C++; NAME by default. The property is DSM<NAME>.
#   TYPE     bool, int, double, enum or directory
#   DEFAULT  value
#   RANGE    least and greatest valid number; without the second, unlimited
#   SLIDER   range of the panel's slider, where it has one
#   CHOICES  numbers that the panel's slider offers instead
#   ENTRIES  of an enum: a name in C++ and a text for each value from 0
#   NEEDS    light: no effect on a volume without Shade; no_volume: none on a volume
#   PANEL    first: below Representation; default or advanced: in the group Ray Tracing. Without: not in the panel.
#   ZERO     what the value 0 means, on the settings page
#   PAGE_DEFAULT, PAGE_ENTRIES  of what is no setting of the ranks, but on the settings page: default, number of entries
set(DSM_SETTINGS)
function (dsm_setting name)
  set(keys OWNER METHOD TYPE DEFAULT LABEL PANEL NEEDS ZERO PAGE_DEFAULT PAGE_ENTRIES CHOICES TEXT)
  set(lists RANGE SLIDER ENTRIES)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "${keys}" "${lists}")
  if (NOT arg_METHOD)
    set(arg_METHOD "${name}")
  endif ()
  if (arg_TEXT MATCHES ";" OR NOT arg_OWNER MATCHES "^(scene|ranks|dataset)$")
    message(FATAL_ERROR "Setting ${name}: the text has a semicolon, or the owner is unknown.")
  endif ()
  string(REGEX REPLACE "[ \n]+" " " arg_TEXT "${arg_TEXT}")
  foreach (key IN LISTS keys lists)
    set(DSM_${name}_${key} "${arg_${key}}" PARENT_SCOPE)
  endforeach ()
  set(DSM_SETTINGS ${DSM_SETTINGS} ${name} PARENT_SCOPE)
endfunction ()
include("${PROJECT_SOURCE_DIR}/vtk_modules/RenderingDSM/options/settings.cmake")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
  "${PROJECT_SOURCE_DIR}/vtk_modules/RenderingDSM/options/settings.cmake")

# Names of the settings that owners have, in the table's order.
function (dsm_settings_of result)
  set(names)
  foreach (name IN LISTS DSM_SETTINGS)
    if (DSM_${name}_OWNER IN_LIST ARGN)
      list(APPEND names ${name})
    endif ()
  endforeach ()
  set(${result} ${names} PARENT_SCOPE)
endfunction ()

# Makes the variables argument, member and kept of a setting: its types in C++, and the valid value of `value`.
macro (dsm_describe_in_cxx name)
  set(argument "${DSM_${name}_TYPE}")
  set(kept "value")
  set(least "")
  if (argument STREQUAL "directory")
    set(argument "const char*")
    set(kept "value ? value : \"\"")
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
    set(other "")
    if (DSM_${name}_ENTRIES)
      set(entries "${DSM_${name}_ENTRIES}")
      while (entries)
        list(POP_FRONT entries constant text)
        string(APPEND other "    ${constant}, ///< ${text}\n")
      endwhile ()
      set(other "  enum ${name}Type\n  {\n${other}  };\n")
    elseif (argument STREQUAL "bool")
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

# Whether a setting is on the settings page.
macro (dsm_is_on_page result name)
  set(${result} FALSE)
  if (DSM_${name}_OWNER STREQUAL "ranks" OR NOT "${DSM_${name}_PAGE_DEFAULT}" STREQUAL "")
    set(${result} TRUE)
  endif ()
endmacro ()

# The definition of a setting's property, of displays or, where isPage, of the settings page.
function (dsm_define_property result name isPage)
  set(type "${DSM_${name}_TYPE}")
  set(default "${DSM_${name}_DEFAULT}")
  set(entries "${DSM_${name}_ENTRIES}")
  set(label "${DSM_${name}_LABEL}")
  if (isPage AND DSM_${name}_ZERO)
    string(APPEND label ", 0 = ${DSM_${name}_ZERO}")
  endif ()
  set(command "Set${DSM_${name}_METHOD}")
  set(kind Int)
  set(domain "")
  set(hints "")
  if (type STREQUAL "directory")
    set(kind String)
    if (isPage)
      set(domain "<FileListDomain name=\"directory\" />")
      set(hints "<UseDirectoryName />")
    endif ()
  elseif (DSM_${name}_CHOICES)
    set(kind Double)
    set(command "${command}Choice")
    set(domain "<DiscreteDoubleDomain name=\"choices\" values=\"${DSM_${name}_CHOICES}\" />")
  elseif (type STREQUAL "bool")
    set(domain "<BooleanDomain name=\"bool\" />")
  elseif (type STREQUAL "enum")
    set(value 0)
    while (entries AND NOT (isPage AND value EQUAL "${DSM_${name}_PAGE_ENTRIES}"))
      list(POP_FRONT entries constant text)
      string(APPEND domain "<Entry text=\"${text}\" value=\"${value}\" />")
      math(EXPR value "${value} + 1")
    endwhile ()
    set(domain "<EnumerationDomain name=\"enum\">${domain}</EnumerationDomain>")
  else ()
    if (type STREQUAL "double")
      set(kind Double)
    endif ()
    set(range ${DSM_${name}_SLIDER})
    if (NOT DSM_${name}_SLIDER)
      set(range ${DSM_${name}_RANGE})
    endif ()
    list(GET range 0 least)
    set(most "")
    list(LENGTH range length)
    if (length GREATER 1)
      list(GET range 1 most)
      set(most "max=\"${most}\" ")
    endif ()
    set(domain "<${kind}RangeDomain ${most}min=\"${least}\" name=\"range\" />")
  endif ()
  dsm_is_on_page(isOnPage ${name})
  set(attributes "")
  if (isPage)
    if (NOT "${DSM_${name}_PAGE_DEFAULT}" STREQUAL "")
      set(default "${DSM_${name}_PAGE_DEFAULT}")
    endif ()
  else ()
    set(attributes " command=\"${command}\"")
    if (DSM_${name}_OWNER STREQUAL "dataset")
      string(APPEND hints "<DSMOfDataset />")
    endif ()
    if (DSM_${name}_PANEL STREQUAL "first")
      string(APPEND hints "${DSM_WHEN_TRACED}")
    endif ()
    if (DSM_${name}_NEEDS)
      string(TOUPPER "DSM_WHEN_${DSM_${name}_NEEDS}" when)
      string(APPEND hints "${${when}}")
    endif ()
    if (isOnPage)
      string(APPEND attributes " no_custom_default=\"1\"")
      # A view's own word counts; the page has that of the ranks.
      set(unlink 1)
      if (DSM_${name}_OWNER STREQUAL "ranks")
        set(unlink 0)
      endif ()
      string(APPEND hints "<PropertyLink group=\"settings\" property=\"DSM${name}\""
        " proxy=\"DSMRayTracerSettings\" unlink_if_modified=\"${unlink}\" />")
    endif ()
  endif ()
  string(REPLACE "<" "&lt;" text "${DSM_${name}_TEXT}")
  set(${result} "<${kind}VectorProperty name=\"DSM${name}\" label=\"${label}\"${attributes}\
 number_of_elements=\"1\" default_values=\"${default}\">${domain}\
<Documentation>${text}</Documentation><Hints>${hints}</Hints></${kind}VectorProperty>\n" PARENT_SCOPE)
endfunction ()

# Makes what the definitions of proxies have of the settings. Of light and memory each: the properties of displays
# (DSM_..._PROPERTIES) and their names (DSM_..._NAMES). The page's properties (DSM_PAGE_PROPERTIES). Of the panel: those
# below Representation (DSM_FIRST_NAMES), of the group Ray Tracing (DSM_GROUP_NAMES), and hidden (DSM_HIDDEN_NAMES).
macro (dsm_define_settings)
  foreach (name IN LISTS DSM_SETTINGS)
    set(which LIGHT)
    if (DSM_${name}_OWNER STREQUAL "ranks")
      set(which MEMORY)
    endif ()
    dsm_define_property(text ${name} FALSE)
    string(APPEND DSM_${which}_PROPERTIES "${text}")
    string(APPEND DSM_${which}_NAMES "<Property name=\"DSM${name}\" />\n")
    dsm_is_on_page(isOnPage ${name})
    if (isOnPage)
      dsm_define_property(text ${name} TRUE)
      string(APPEND DSM_PAGE_PROPERTIES "${text}")
    endif ()
    set(panel "${DSM_${name}_PANEL}")
    if (panel STREQUAL "first")
      string(APPEND DSM_FIRST_NAMES "<Property name=\"DSM${name}\" />\n")
    elseif (panel)
      string(APPEND DSM_GROUP_NAMES "<Property name=\"DSM${name}\" panel_visibility=\"${panel}\" />\n")
    else ()
      string(APPEND DSM_HIDDEN_NAMES "<Property name=\"DSM${name}\" panel_visibility=\"never\" />\n")
    endif ()
  endforeach ()
endmacro ()

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
  foreach (name IN LISTS DSM_SETTINGS)
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
