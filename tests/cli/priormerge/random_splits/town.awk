# A made-up town: rows of touching houses of random height, roof and parts along two streets. -v format=osm|gml -v seed=N
function node(x, y) { nodes[++num_nodes] = sprintf("<node id='%d' lat='%.7f' lon='%.7f'/>", num_nodes, 48.18 + y / 111200, 11.55 + x / 74300); return num_nodes }
function box(x0, y0, x1, y1, tags,   a, b, c, d) {
  a = node(x0, y0); b = node(x1, y0); c = node(x1, y1); d = node(x0, y1)
  ways[++num_ways] = sprintf("<way id='%d'><nd ref='%d'/><nd ref='%d'/><nd ref='%d'/><nd ref='%d'/><nd ref='%d'/>%s</way>", num_ways, a, b, c, d, a, tags)
}
function tag(key, value) { return "<tag k='" key "' v='" value "'/>" }
function polygon(list) { return "<surfaceMember><Polygon><exterior><LinearRing><posList>" list "</posList></LinearRing></exterior></Polygon></surfaceMember>" }
function p(x, y, z) { return sprintf("%.3f %.3f %.3f ", 689546 + x, 5339451 + y, z) }
function solid(x0, y0, x1, y1, top) {
  printf "<cityObjectMember><Building id='b%d'><lod1Solid><Solid><exterior><CompositeSurface>", ++num_solids
  print polygon(p(x0,y0,0) p(x0,y1,0) p(x1,y1,0) p(x1,y0,0) p(x0,y0,0)) polygon(p(x0,y0,top) p(x1,y0,top) p(x1,y1,top) p(x0,y1,top) p(x0,y0,top))
  print polygon(p(x0,y0,0) p(x1,y0,0) p(x1,y0,top) p(x0,y0,top) p(x0,y0,0)) polygon(p(x1,y0,0) p(x1,y1,0) p(x1,y1,top) p(x1,y0,top) p(x1,y0,0))
  print polygon(p(x1,y1,0) p(x0,y1,0) p(x0,y1,top) p(x1,y1,top) p(x1,y1,0)) polygon(p(x0,y1,0) p(x0,y0,0) p(x0,y0,top) p(x0,y1,top) p(x0,y1,0))
  print "</CompositeSurface></exterior></Solid></lod1Solid></Building></cityObjectMember>"
}
BEGIN {
  srand(seed)
  split("flat gabled hipped pyramidal skillion mansard dome", roofs, " ")
  if (format == "gml") print "<CityModel><boundedBy><Envelope srsName='EPSG:25832'/></boundedBy>"
  for (row = 0; row < 4; ++row) {
    for (x = 0; x < 150; x += width) {
      width = 6 + int(10 * rand()); depth = 8 + int(8 * rand()); y = 40 * row; height = 3 + int(15 * rand())
      if (rand() < 0.2) continue
      if (format == "gml") { solid(x, y, x + width, y + depth, height); continue }
      tags = tag("building", "yes") (rand() < 0.6 ? tag("height", height) : "") tag("roof:shape", roofs[1 + int(7 * rand())])
      box(x, y, x + width, y + depth, tags)
      if (rand() < 0.2) box(x + 1, y + 1, x + 4, y + 4, tag("building:part", "yes") tag("height", height + 6))
    }
  }
  if (format == "gml") { print "</CityModel>"; exit }
  for (y = 30; y < 150; y += 80) {
    a = node(-20, y); b = node(170, y)
    ways[++num_ways] = sprintf("<way id='%d'><nd ref='%d'/><nd ref='%d'/>%s</way>", num_ways, a, b, tag("highway", "residential"))
  }
  print "<osm version='0.6'>"
  for (i = 1; i <= num_nodes; ++i) print nodes[i]
  for (i = 1; i <= num_ways; ++i) print ways[i]
  print "</osm>"
}
