//! The names of the nodes and fields that this reader supports.

/// The type of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeType {
    /// Keeps the state that its children set.
    Group,
    /// Restores the state after its children.
    Separator,
    /// Restores the transform after its children.
    TransformSeparator,
    Switch,
    /// Levels of detail, the finest first; the reader uses the first.
    Levels,
    Array,
    MultipleCopy,
    /// Includes another file.
    Include,
    Transform,
    Translation,
    Rotation,
    RotationXyz,
    Scale,
    MatrixTransform,
    ResetTransform,
    Units,
    Coordinate3,
    Coordinate4,
    Normal,
    NormalBinding,
    Material,
    MaterialBinding,
    BaseColor,
    PackedColor,
    VertexProperty,
    ShapeHints,
    LightModel,
    DrawStyle,
    Environment,
    Cube,
    Sphere,
    Cone,
    Cylinder,
    IndexedFaceSet,
    FaceSet,
    IndexedTriangleStripSet,
    TriangleStripSet,
    QuadMesh,
    PointLight,
    SpotLight,
    DirectionalLight,
    PerspectiveCamera,
    /// Not supported: ignored with a warning.
    Unsupported,
    /// Has no effect on the scene: ignored without a warning.
    Irrelevant,
}

impl NodeType {
    /// The type of a node by its name; `None` if the name is unknown.
    pub fn of(name: &[u8]) -> Option<NodeType> {
        NODES.iter().find(|(known, _)| known.as_bytes() == name).map(|(_, kind)| *kind)
    }

    /// True if the node may have children.
    pub fn has_children(self) -> bool {
        use NodeType::{Array, Group, Irrelevant, Levels, MultipleCopy, Separator, Switch, TransformSeparator};
        matches!(self, Group | Separator | TransformSeparator | Switch | Levels | Array | MultipleCopy | Irrelevant)
    }

    /// True if `~` after the value of a field has an effect. The reference implementation does not look for it in face
    /// sets and copies, except for `origin`: there the value counts.
    pub fn can_ignore(self, field: &str) -> bool {
        use NodeType::{Array, FaceSet, IndexedFaceSet, IndexedTriangleStripSet, QuadMesh, TriangleStripSet};
        match self {
            Array => field == "origin",
            NodeType::MultipleCopy => false,
            _ => !matches!(self, IndexedFaceSet | FaceSet | IndexedTriangleStripSet | TriangleStripSet | QuadMesh),
        }
    }
}

/// The field of that name, if this reader supports it.
pub fn field(name: &[u8]) -> Option<&'static str> {
    FIELDS.iter().find(|known| known.as_bytes() == name).copied()
}

/// The rule for a value of a numeric field that is not a finite number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotANumber {
    /// It is an error.
    Refused,
    /// A position: it is kept if it is a spelling of a number that is none.
    Position,
    /// Not geometry: it becomes NaN, and what it belongs to has its default.
    Default,
    /// The field has words, which may begin like numbers.
    Word,
}

impl NotANumber {
    /// The rule of a field.
    pub fn of(field: &str) -> NotANumber {
        match field {
            "point" | "vertex" => NotANumber::Position,
            "ambientColor" | "ambientIntensity" | "color" | "creaseAngle" | "diffuseColor" | "direction"
            | "emissiveColor" | "heightAngle" | "intensity" | "location" | "materialIndex" | "normal"
            | "normalIndex" | "orderedRGBA" | "orientation" | "position" | "rgb" | "rgba" | "shininess"
            | "specularColor" | "transparency" | "vector" => NotANumber::Default,
            "axis" | "materialBinding" | "model" | "name" | "normalBinding" | "origin" | "parts" | "style"
            | "units" | "value" | "vertexOrdering" | "whatToReset" => NotANumber::Word,
            _ => NotANumber::Refused,
        }
    }
}

const NODES: &[(&str, NodeType)] = &[
    ("Separator", NodeType::Separator),
    ("Group", NodeType::Group),
    ("Transform", NodeType::Transform),
    ("Material", NodeType::Material),
    ("Coordinate3", NodeType::Coordinate3),
    ("IndexedFaceSet", NodeType::IndexedFaceSet),
    ("Normal", NodeType::Normal),
    ("NormalBinding", NodeType::NormalBinding),
    ("MaterialBinding", NodeType::MaterialBinding),
    ("ShapeHints", NodeType::ShapeHints),
    ("Translation", NodeType::Translation),
    ("Rotation", NodeType::Rotation),
    ("RotationXYZ", NodeType::RotationXyz),
    // Animated nodes keep their initial state.
    ("Rotor", NodeType::Rotation),
    ("Scale", NodeType::Scale),
    ("MatrixTransform", NodeType::MatrixTransform),
    ("ResetTransform", NodeType::ResetTransform),
    ("Units", NodeType::Units),
    ("TransformSeparator", NodeType::TransformSeparator),
    ("Switch", NodeType::Switch),
    ("Blinker", NodeType::Switch),
    ("LOD", NodeType::Levels),
    ("LevelOfDetail", NodeType::Levels),
    ("Array", NodeType::Array),
    ("MultipleCopy", NodeType::MultipleCopy),
    ("File", NodeType::Include),
    ("WWWInline", NodeType::Include),
    // These are separators with additional properties that no image shows.
    ("WWWAnchor", NodeType::Separator),
    ("Annotation", NodeType::Separator),
    ("Selection", NodeType::Separator),
    ("LocateHighlight", NodeType::Separator),
    ("Coordinate4", NodeType::Coordinate4),
    ("BaseColor", NodeType::BaseColor),
    ("PackedColor", NodeType::PackedColor),
    ("VertexProperty", NodeType::VertexProperty),
    ("LightModel", NodeType::LightModel),
    ("DrawStyle", NodeType::DrawStyle),
    ("Environment", NodeType::Environment),
    ("Cube", NodeType::Cube),
    ("Sphere", NodeType::Sphere),
    ("Cone", NodeType::Cone),
    ("Cylinder", NodeType::Cylinder),
    ("FaceSet", NodeType::FaceSet),
    ("IndexedTriangleStripSet", NodeType::IndexedTriangleStripSet),
    ("TriangleStripSet", NodeType::TriangleStripSet),
    ("QuadMesh", NodeType::QuadMesh),
    ("PointLight", NodeType::PointLight),
    ("SpotLight", NodeType::SpotLight),
    ("DirectionalLight", NodeType::DirectionalLight),
    ("PerspectiveCamera", NodeType::PerspectiveCamera),
    ("OrthographicCamera", NodeType::Unsupported),
    ("IndexedLineSet", NodeType::Unsupported),
    ("LineSet", NodeType::Unsupported),
    ("PointSet", NodeType::Unsupported),
    ("MarkerSet", NodeType::Unsupported),
    ("Text2", NodeType::Unsupported),
    ("Text3", NodeType::Unsupported),
    ("AsciiText", NodeType::Unsupported),
    ("NurbsCurve", NodeType::Unsupported),
    ("IndexedNurbsCurve", NodeType::Unsupported),
    ("NurbsSurface", NodeType::Unsupported),
    ("IndexedNurbsSurface", NodeType::Unsupported),
    ("Texture2", NodeType::Unsupported),
    ("ClipPlane", NodeType::Unsupported),
    ("Info", NodeType::Irrelevant),
    ("Label", NodeType::Irrelevant),
    ("Complexity", NodeType::Irrelevant),
    ("PickStyle", NodeType::Irrelevant),
    ("ColorIndex", NodeType::Irrelevant),
    ("EventCallback", NodeType::Irrelevant),
    // These only affect text and textures, for which there is a warning.
    ("Font", NodeType::Irrelevant),
    ("FontStyle", NodeType::Irrelevant),
    ("ProfileCoordinate2", NodeType::Irrelevant),
    ("ProfileCoordinate3", NodeType::Irrelevant),
    ("LinearProfile", NodeType::Irrelevant),
    ("NurbsProfile", NodeType::Irrelevant),
    ("Texture2Transform", NodeType::Irrelevant),
    ("TextureCoordinate2", NodeType::Irrelevant),
    ("TextureCoordinateBinding", NodeType::Irrelevant),
    ("TextureCoordinateDefault", NodeType::Irrelevant),
    ("TextureCoordinateEnvironment", NodeType::Irrelevant),
    ("TextureCoordinatePlane", NodeType::Irrelevant),
];

const FIELDS: &[&str] = &[
    "ambientColor",
    "ambientIntensity",
    "angle",
    "axis",
    "bottomRadius",
    "center",
    "color",
    "coordIndex",
    "creaseAngle",
    "depth",
    "diffuseColor",
    "direction",
    "emissiveColor",
    "height",
    "heightAngle",
    "intensity",
    "location",
    "materialBinding",
    "materialIndex",
    "matrix",
    "model",
    "name",
    "normal",
    "normalBinding",
    "normalIndex",
    "numElements1",
    "numElements2",
    "numElements3",
    "numVertices",
    "on",
    "orderedRGBA",
    "orientation",
    "origin",
    "parts",
    "point",
    "position",
    "radius",
    "rgb",
    "rgba",
    "rotation",
    "scaleFactor",
    "scaleOrientation",
    "separation1",
    "separation2",
    "separation3",
    "shininess",
    "specularColor",
    "startIndex",
    "style",
    "translation",
    "transparency",
    "units",
    "value",
    "vector",
    "vertex",
    "vertexOrdering",
    "vertexProperty",
    "verticesPerColumn",
    "verticesPerRow",
    "whatToReset",
    "whichChild",
    "width",
];
