#include "program_readers.hpp"

#include <tinyxml2.h>

#include <cstdlib>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace posewright::readers {
namespace {

const std::string number = R"((-?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?))";

[[noreturn]] void bad(const std::string& line) { throw std::runtime_error("not understood: " + line); }

/// Lines without their ends; `crlf` demands the one or the other.
std::vector<std::string> lines_of(const std::string& text, bool crlf) {
  if (text.find_first_of("\r\n") == text.npos || text.back() != '\n') throw std::runtime_error("no last line end");
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (crlf != (!line.empty() && line.back() == '\r')) throw std::runtime_error("wrong line end: " + line);
    if (crlf) line.pop_back();
    for (const char c : line)
      if (c != '\t' && (c < 0x20 || c > 0x7E)) throw std::runtime_error("not ASCII: " + line);
    if (std::regex_search(line, std::regex(R"(-0(\.0*)?(?![0-9.]))"))) throw std::runtime_error("minus zero: " + line);
    lines.push_back(line);
  }
  return lines;
}

std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> values;
  const std::regex pattern(number);
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
    values.push_back(std::strtod((*it)[1].str().c_str(), nullptr));
  return values;
}

bool match(const std::string& line, const std::string& pattern, std::smatch& found) {
  return std::regex_match(line, found, std::regex(pattern));
}

/// The handshake: up, wait for high or time, down, wait for low; nothing else may come between.
class Handshake {
 public:
  explicit Handshake(Program& program) : program_(program) {}
  void settle() { step(0, 1); }
  void up() { step(1, 2); }
  void wait_high() { step(2, 3); }
  void wait_time() { step(2, 5); }
  void down() {
    if (state_ == 0 && program_.moves.empty()) return;  // switched off at the start
    if (state_ != 3 && state_ != 5) throw std::runtime_error("the output goes down without a measurement");
    state_ = state_ == 5 ? 0 : 4;
    program_.measured.push_back(program_.moves.size() - 1);
  }
  void wait_low() { step(4, 0); }
  void timer() { state_ == 2 ? wait_time() : settle(); }
  void idle() const {
    if (state_ != 0) throw std::runtime_error("a handshake is not finished");
  }
  void move(const std::vector<double>& q) {
    idle();
    program_.moves.push_back(q);
  }
  void stop() {
    idle();
    program_.stops.push_back(program_.moves.size());
  }

 private:
  void step(int from, int to) {
    if (state_ != from) throw std::runtime_error("handshake out of order");
    state_ = to;
  }
  Program& program_;
  int state_ = 0;
};

}  // namespace

Program read_krl(const std::string& source, const std::string& data, const std::string& name) {
  Program program;
  Handshake handshake(program);
  std::smatch m;
  std::map<std::string, std::vector<double>> points;
  std::string points_number;
  const auto declared = lines_of(data, true);
  if (declared.size() < 5 || declared[0] != "&ACCESS RVP" || declared[2] != "DEFDAT  " + name ||
      declared.back() != "ENDDAT")
    throw std::runtime_error("no data list");
  for (std::size_t i = 3; i + 1 < declared.size(); ++i) {
    if (declared[i].front() == ';' || declared[i] == "EXT  BAS (BAS_COMMAND  :IN,REAL  :IN )") continue;
    if (match(declared[i], "DECL INT NPOINTS=([0-9]+)", m)) {
      points_number = m[1].str();
      continue;
    }
    if (!match(declared[i], R"(DECL E6AXIS ([A-Z][A-Z0-9_]*)=\{((?:[AE][1-6] -?[0-9.]+,?)+)\})", m)) bad(declared[i]);
    const std::string& listed = m[2].str();
    std::vector<double> q;
    const std::regex axis("([AE][1-6]) " + number);
    std::string before;
    for (std::sregex_iterator it(listed.begin(), listed.end(), axis), end; it != end; ++it) {
      if (!(before < (*it)[1].str())) throw std::runtime_error("axes out of order");
      before = (*it)[1].str();
      q.push_back(std::strtod((*it)[2].str().c_str(), nullptr));
    }
    if (!points.emplace(m[1].str(), q).second) throw std::runtime_error("declared twice: " + m[1].str());
  }
  bool guarded = false;
  const auto lines = lines_of(source, true);
  if (lines[2] != "DEF  " + name + " ( )" || lines.back() != "END") throw std::runtime_error("no program");
  for (std::size_t i = 3; i + 1 < lines.size(); ++i) {
    const std::string& line = lines[i];
    if (match(line, "WHILE NPOINTS<>([0-9]+)", m)) {
      // The loop halts for ever beside other points, before the first move.
      if (m[1].str() != points_number || !program.moves.empty()) throw std::runtime_error("points of another program");
      if (lines.at(i + 2) != "HALT" || lines.at(i + 3) != "ENDWHILE") bad(line);
      guarded = true;
      i += 3;
    } else if (line.front() == ';') program.comments.push_back(line.substr(1));
    else if (match(line, "PTP ([A-Z0-9_]+)", m)) handshake.move(points.at(m[1].str()));
    else if (match(line, "WAIT SEC " + number, m)) handshake.timer();
    else if (match(line, R"(\$OUT\[[0-9]+\]=TRUE)", m)) handshake.up();
    else if (match(line, R"(\$OUT\[[0-9]+\]=FALSE)", m)) handshake.down();
    else if (match(line, R"(WAIT FOR \$IN\[[0-9]+\])", m)) handshake.wait_high();
    else if (match(line, R"(WAIT FOR NOT \$IN\[[0-9]+\])", m)) handshake.wait_low();
    else if (line == "HALT") handshake.stop();
    else if (!match(line, R"(BAS \(#(INITMOV|VEL_PTP|ACC_PTP|TOOL|BASE),[0-9]+ ?\))", m)) bad(line);
  }
  if (!guarded) throw std::runtime_error("nothing asks whose points these are");
  handshake.idle();
  return program;
}

Program read_rapid(const std::string& module) {
  Program program;
  Handshake handshake(program);
  std::smatch m;
  std::map<std::string, std::vector<double>> points;
  const auto lines = lines_of(module, true);
  if (!match(lines.front(), "MODULE ([A-Za-z][A-Za-z0-9_]*)", m) || lines.back() != "ENDMODULE")
    throw std::runtime_error("no module");
  bool inside = false;
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
    const std::string line = lines[i].substr(std::min(lines[i].find_first_not_of(' '), lines[i].size()));
    if (line.front() == '!') program.comments.push_back(line.substr(2));
    else if (!inside && match(line, R"(CONST jointtarget (\w+):=\[\[(.*)\],\[(.*)\]\];)", m)) {
      std::vector<double> q = numbers_in(m[2].str());
      if (q.size() != 6 || numbers_in(m[3].str()).size() != 6) bad(line);
      for (const double e : numbers_in(m[3].str()))
        if (e != 9e9) q.push_back(e);
      points[m[1].str()] = q;
    } else if (line == "PROC CalMain()") inside = true;
    else if (line == "ENDPROC") inside = false;
    else if (!inside) bad(line);
    else if (match(line, R"(MoveAbsJ (\w+)\\NoEOffs,v1000,fine,(\w+);)", m)) {
      handshake.move(points.at(m[1].str()));
      program.tools.insert(m[2].str());
    } else if (match(line, "WaitTime " + number + ";", m)) handshake.timer();
    else if (match(line, R"(SetDO \w+,1;)", m)) handshake.up();
    else if (match(line, R"(SetDO \w+,0;)", m)) handshake.down();
    else if (match(line, R"(WaitDI \w+,1;)", m)) handshake.wait_high();
    else if (match(line, R"(WaitDI \w+,0;)", m)) handshake.wait_low();
    else if (match(line, "TPWrite \"([^\"]{1,80})\";", m)) program.messages.push_back(m[1].str());
    else if (line == "Stop;") handshake.stop();
    else if (line != "WaitRob\\ZeroSpeed;" && !match(line, "VelSet [0-9.]+,[0-9.]+;", m)) bad(line);
  }
  handshake.idle();
  return program;
}

Program read_tp(const std::string& listing) {
  Program program;
  Handshake handshake(program);
  std::smatch m;
  const auto lines = lines_of(listing, true);
  if (!match(lines.front(), "/PROG  ([A-Z][A-Z0-9_]*)", m) || lines[1] != "/ATTR" || lines.back() != "/END")
    throw std::runtime_error("no listing");
  std::size_t i = 2, count = 0, said = 0;
  for (; lines[i] != "/MN"; ++i)
    if (match(lines[i], "LINE_COUNT\t= ([0-9]+);", m)) said = std::stoul(m[1].str());
  std::vector<std::string> main;
  for (++i; lines[i] != "/POS"; ++i) {
    if (!match(lines[i], "([ 0-9]{4}):(.*) *;", m) || std::stoul(m[1].str()) != ++count) bad(lines[i]);
    main.push_back(m[2].str());
  }
  if (count != said) throw std::runtime_error("LINE_COUNT is wrong");
  std::string positions;
  for (++i; i + 1 < lines.size(); ++i) positions += lines[i] + "\n";
  std::map<int, std::vector<double>> points;
  const std::regex block(
      R"(P\[([0-9]+)\]\{\n   GP1:\n\tUF : [0-9]+, UT : [0-9]+,\n((?:\t[^\n]*\n){2,3})(?:   GP2:\n\tUF : [0-9]+, UT : [0-9]+,\n(\t[^\n]*\n))?\};\n)");
  std::size_t read = 0;
  for (std::sregex_iterator it(positions.begin(), positions.end(), block), end; it != end; ++it) {
    const std::string arm = (*it)[2].str(), positioner = (*it)[3].str();
    read += std::size_t(it->length());
    std::vector<double> q;
    const auto take = [&](const std::string& body, const char* letter, const char* units) {
      const std::regex axis(std::string(letter) + "([1-9])= +" + number + " (" + units + ")");
      std::size_t axes = 0;
      for (std::sregex_iterator a(body.begin(), body.end(), axis); a != end; ++a) {
        if (std::stoul((*a)[1].str()) != ++axes) throw std::runtime_error("axes out of order");
        q.push_back(std::strtod((*a)[2].str().c_str(), nullptr));
      }
    };
    take(arm, "J", "deg");
    if (q.size() != 6) throw std::runtime_error("not six axes");
    take(arm, "E", "deg|mm");
    take(positioner, "J", "deg|mm");
    points[std::stoi((*it)[1].str())] = q;
  }
  if (read != positions.size()) throw std::runtime_error("positions not understood");
  for (std::string line : main) {
    line.erase(line.find_last_not_of(' ') + 1);
    if (match(line, R"(J P\[([0-9]+)\] [0-9]+% FINE)", m)) handshake.move(points.at(std::stoi(m[1].str())));
    else if (match(line, "  !(.{1,32})", m)) program.comments.push_back(m[1].str());
    else if (match(line, R"(  WAIT +)" + number + R"(\(sec\))", m)) handshake.timer();
    else if (match(line, R"(  DO\[[0-9]+\]=ON)", m)) handshake.up();
    else if (match(line, R"(  DO\[[0-9]+\]=OFF)", m)) handshake.down();
    else if (match(line, R"(  WAIT DI\[[0-9]+\]=ON)", m)) handshake.wait_high();
    else if (match(line, R"(  WAIT DI\[[0-9]+\]=OFF)", m)) handshake.wait_low();
    else if (match(line, R"(  MESSAGE\[(.{1,24})\])", m)) program.messages.push_back(m[1].str());
    else if (line == "  PAUSE") handshake.stop();
    else if (program.moves.empty() && match(line, R"(  PAYLOAD\[([0-9]+)\])", m))
      program.load = {double(std::stoi(m[1].str()))};
    else if (!match(line, "  U(FRAME|TOOL)_NUM=[0-9]+", m)) bad(line);
  }
  handshake.idle();
  return program;
}

Program read_urscript(const std::string& script) {
  Program program;
  Handshake handshake(program);
  std::smatch m;
  const auto lines = lines_of(script, false);
  if (!match(lines.front(), R"(def [a-zA-Z]\w*\(\):)", m) || lines.back() != "end")
    throw std::runtime_error("no function");
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
    const std::string& line = lines[i];
    const auto loop = [&](const char* state) {
      const bool found =
          match(line, std::string(R"(  while \(get_standard_digital_in\([0-7]\) == )") + state + R"(\):)", m) &&
          lines[i + 1] == "    sync()" && lines[i + 2] == "  end";
      if (found) i += 2;
      return found;
    };
    if (line.starts_with("  # ")) program.comments.push_back(line.substr(4));
    else if (match(line, R"(  movej\(\[(.*)\], a=[0-9.]+, v=[0-9.]+\))", m)) handshake.move(numbers_in(m[1].str()));
    else if (match(line, R"(  sleep\()" + number + R"(\))", m)) handshake.timer();
    else if (program.moves.empty() && match(line, R"(  set_payload\((.*), \[(.*)\]\))", m))
      program.load = numbers_in(m[1].str() + ", " + m[2].str());
    else if (match(line, R"(  set_standard_digital_out\([0-7], True\))", m)) handshake.up();
    else if (match(line, R"(  set_standard_digital_out\([0-7], False\))", m)) handshake.down();
    else if (loop("False")) handshake.wait_high();
    else if (loop("True")) handshake.wait_low();
    else if (match(line, R"re(  popup\("([^"]*)", title="[^"]*", blocking=True\))re", m)) {
      program.messages.push_back(m[1].str());
      handshake.stop();
    } else bad(line);
  }
  handshake.idle();
  return program;
}

Program read_inform(const std::string& job) {
  Program program;
  Handshake handshake(program);
  std::smatch m;
  const auto lines = lines_of(job, true);
  const char* head[] = {"/JOB",           "//NAME [A-Z][A-Z0-9_]*", "//POS",   "///NPOS ([0-9]+),0,0,0,0,0",
                        "///TOOL [0-9]+", "///POSTYPE PULSE",       "///PULSE"};
  std::size_t i = 0, count = 0;
  for (const char* pattern : head) {
    if (!match(lines[i], pattern, m)) bad(lines[i]);
    if (m.size() > 1) count = std::stoul(m[1].str());
    ++i;
  }
  std::vector<std::vector<double>> points;
  for (; match(lines[i], "C([0-9]{5})=((?:-?[0-9]+,){5}-?[0-9]+)", m); ++i) {
    if (std::stoul(m[1].str()) != points.size()) bad(lines[i]);
    points.push_back(numbers_in(m[2].str()));
  }
  if (points.size() != count) throw std::runtime_error("NPOS is wrong");
  for (const char* pattern : {"//INST", "///DATE [0-9]{4}/[0-9]{2}/[0-9]{2} [0-9]{2}:[0-9]{2}", "///COMM .{1,32}",
                              "///ATTR SC,RW", "///GROUP1 RB1", "NOP"})
    if (!match(lines[i++], pattern, m)) bad(lines[i - 1]);
  for (; i + 1 < lines.size(); ++i) {
    const std::string& line = lines[i];
    if (match(line, "'(.{1,32})", m)) program.comments.push_back(m[1].str());
    else if (match(line, "MOVJ C([0-9]{5}) VJ=[0-9.]+ PL=0", m)) handshake.move(points.at(std::stoul(m[1].str())));
    else if (match(line, "TIMER T=" + number, m)) handshake.timer();
    else if (match(line, R"(DOUT OT#\([0-9]+\) ON)", m)) handshake.up();
    else if (match(line, R"(DOUT OT#\([0-9]+\) OFF)", m)) handshake.down();
    else if (match(line, R"(WAIT IN#\([0-9]+\)=ON)", m)) handshake.wait_high();
    else if (match(line, R"(WAIT IN#\([0-9]+\)=OFF)", m)) handshake.wait_low();
    else if (match(line, "MSG \"(.{1,32})\"", m)) program.messages.push_back(m[1].str());
    else if (line == "PAUSE") handshake.stop();
    else bad(line);
  }
  if (lines.back() != "END") throw std::runtime_error("no END");
  handshake.idle();
  return program;
}

namespace {

void parse_xml(tinyxml2::XMLDocument& document, const std::string& text) {
  lines_of(text, true);
  if (document.Parse(text.c_str()) != tinyxml2::XML_SUCCESS) throw std::runtime_error("no XML");
}

std::vector<std::string> code_of(const std::string& text, const char* name) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text);
  const auto* program = document.FirstChildElement("Programs")->FirstChildElement("Program");
  if (std::string(program->Attribute("name")) != name) throw std::runtime_error("wrong program");
  std::istringstream stream(program->FirstChildElement("Code")->GetText());
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    lines.push_back(line.substr(std::min(line.find_first_not_of(' '), line.size())));
  }
  if (lines.front() != "begin" || lines.back() != "end") throw std::runtime_error("no begin and end");
  return {lines.begin() + 1, lines.end() - 1};
}

}  // namespace

Program read_val3(const std::map<std::string, std::string>& files, const std::string& name) {
  Program program;
  Handshake handshake(program);
  std::smatch m;
  tinyxml2::XMLDocument project, data;
  parse_xml(project, files.at(name + ".pjx"));
  std::vector<std::string> listed;
  const auto* root = project.FirstChildElement("Project");
  for (const auto* p = root->FirstChildElement("Programs")->FirstChildElement(); p != nullptr;
       p = p->NextSiblingElement())
    listed.emplace_back(p->Attribute("file"));
  listed.emplace_back(root->FirstChildElement("Database")->FirstChildElement()->Attribute("file"));
  for (const std::string& file : listed)
    if (files.count(file) == 0) throw std::runtime_error("missing " + file);
  if (listed.size() + 1 != files.size()) throw std::runtime_error("files that the project does not name");
  parse_xml(data, files.at(name + ".dtx"));
  std::vector<std::vector<double>> points;
  std::string points_number;
  const auto* datas = data.FirstChildElement("Database")->FirstChildElement("Datas");
  for (const auto* d = datas->FirstChildElement("Data"); d != nullptr; d = d->NextSiblingElement("Data")) {
    if (std::string(d->Attribute("name")) == "nPoints")
      points_number = d->FirstChildElement("Value")->Attribute("value");
    if (std::string(d->Attribute("name")) != "jCal") continue;
    for (const auto* v = d->FirstChildElement("Value"); v != nullptr; v = v->NextSiblingElement("Value")) {
      if (std::stoul(v->Attribute("key")) != points.size()) throw std::runtime_error("keys out of order");
      points.emplace_back();
      for (const char* axis : {"j1", "j2", "j3", "j4", "j5", "j6"})
        points.back().push_back(std::strtod(v->Attribute(axis), nullptr));
    }
    if (std::stoul(d->Attribute("size")) != points.size()) throw std::runtime_error("wrong size");
  }
  const auto measure = code_of(files.at("measure.pgx"), "measure");
  const auto start = code_of(files.at("start.pgx"), "start");
  for (std::size_t i = 0; i < start.size(); ++i) {
    const std::string& line = start[i];
    if (match(line, "if nPoints!=([0-9]+)", m)) {
      if (m[1].str() != points_number || !program.moves.empty()) throw std::runtime_error("points of another program");
      if (start.at(i + 2) != "return" || start.at(i + 3) != "endIf") bad(line);
      i += 3;
    } else if (line.starts_with("//")) program.comments.push_back(line.substr(3));
    else if (match(line, R"(nTraj=movej\(jCal\[([0-9]+)\],flange\[0\],mSlow\[0\]\))", m)) {
      handshake.move(points.at(std::stoul(m[1].str())));
      if (start.at(++i) != "waitEndMove()") bad(start[i]);
    } else if (line == "call measure()") {
      for (const std::string& step : measure) {
        if (match(step, R"(delay\()" + number + R"(\))", m)) handshake.timer();
        else if (match(step, R"(\w+=true)", m)) handshake.up();
        else if (match(step, R"(\w+=false)", m)) handshake.down();
        else if (match(step, R"(wait\(\w+==true\))", m)) handshake.wait_high();
        else if (match(step, R"(wait\(\w+==false\))", m)) handshake.wait_low();
        else if (!step.starts_with("//")) bad(step);
      }
    } else if (match(line, R"re(putln\("([^"]*)"\))re", m)) {
      if (m[1].str() != "press a key") program.messages.push_back(m[1].str());
    } else if (line == "nKey=get()") {
      handshake.stop();
    } else if (line != "userPage()" && line != "cls()" && !match(line, R"(\w+=false)", m)) {
      bad(line);
    }
  }
  handshake.idle();
  return program;
}

Program read_gcs(const std::string& commands) {
  Program program;
  std::smatch m;
  const auto lines = lines_of(commands, false);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    const std::string pattern =
        "MOV X " + number + " Y " + number + " Z " + number + " U " + number + " V " + number + " W " + number;
    if (match(line, pattern, m)) {
      std::vector<double> q;
      for (std::size_t k = 1; k <= 6; ++k) q.push_back(std::strtod(m[k].str().c_str(), nullptr));
      if (lines.at(i + 1) != "ONT?") bad(line);
      ++i;
      if (i + 1 < lines.size() && lines[i + 1].starts_with("SPI R ")) continue;  // to zero, to set the pivot
      program.moves.push_back(q);
    } else if (line == "POS?") {
      program.measured.push_back(program.moves.size() - 1);
    } else if (line != "SVO X 1 Y 1 Z 1 U 1 V 1 W 1" && !match(line, "VLS [0-9.]+", m) &&
               !match(line, "SPI R " + number + " S " + number + " T " + number, m)) {
      bad(line);
    }
  }
  return program;
}

}  // namespace posewright::readers
