/**
 * Of a result (posewright/report-of-result/1; schemas/ says what each result holds) and of two plans
 * (posewright/report-of-two-plans/1).
 * @typedef {{version: string, title: string, file: string, refresh: number, result: any}} ResultReport refresh: s, 0: never
 * @typedef {{version: string, title: string, files: [string, string], plans: [Report, Report]}} TwoPlansReport
 *
 * Of a problem without a plan (posewright/report-of-problem/1), with the drawn parts of Report.
 * @typedef {{version: string, title: string, problem: {file: string, sha256: string}, seed: number, notes: string[], faults: string[], reasons: string[], verdicts: number[], evenly: number, cell: {frame: number, placement: Placement}}} ProblemReport
 *
 * Shapes of the data, schema posewright/report/1. SI units; 7-vectors are x y z qx qy qz qw in the measurement frame;
 * "packed" is the lower triangle, row by row, of a symmetric matrix.
 *
 * @typedef {[number, number, number]} Point
 * @typedef {number[]} Placement x y z qx qy qz qw
 *
 * @typedef {{type: 'box', size: Point} | {type: 'cylinder', radius: number, length: number}
 *   | {type: 'sphere', radius: number} | {type: 'plane', normal: Point}
 *   | {type: 'mesh', vertices: number[], triangles: number[]}} Shape
 * @typedef {{name: string, kind: 'robot'|'tool'|'obstacle', frame: number, placement: Placement, shape: Shape,
 *   colour?: [number, number, number]}} Body colour: red, green, blue, 0 to 1
 *
 * @typedef {object} Keyframe
 * @property {number|null} pose id of the pose where the robot stands, 0: home, null: on the way
 * @property {number} seconds elapsed
 * @property {Placement[]} frames one per entry of Report.frames
 * @property {Point[][]} lines skeleton, polylines
 * @property {Placement} tip
 * @property {(Point|null)[]} targets null: of an instrument that does not read here
 * @property {string} [instrument] of several: that reads
 *
 * @typedef {{name: string, unit: string, tolerance: number, role: 'interest'|'nuisance', variant: string}} Column
 * @typedef {{poses: number, log_det: number|null, rho0: number|null, largest_sigma_ratio: number|null}} CurvePoint
 * @typedef {{sensitivity: number[], bound: number, positions: number[], chosen: number[]}} Candidates
 *
 * A pose where the program of the page around this one has judged it (posewright/judged-poses/1).
 * @typedef {object} JudgedPose
 * @property {string|null} reason that forbids it
 * @property {any} pose as in plan.json
 * @property {Keyframe} keyframe
 * @property {number[]} packed JᵀJ, columns as in Information
 * @property {([number, number]|null)[]|null} pixels as Camera.pictures
 *
 * @typedef {object} Camera
 * @property {string} [instrument] of several: its name
 * @property {string[]} [with] names of several that read together, it among them
 * @property {{frame: number, placement: Placement}} camera in the frame that carries it
 * @property {{frame: number, placement: Placement}} board
 * @property {[number, number]} size px
 * @property {Point[]} corners lines of sight of the picture's corners, camera frame
 * @property {string[]} names
 * @property {Point[]} points board frame
 * @property {{pose: number, pixels: ([number, number]|null)[]}[]} pictures
 *
 * @typedef {object} Information columns in units of their tolerance, nuisance first
 * @property {number[]} factor L, packed: L Lᵀ is the information of all poses and the prior
 * @property {{id: number, rows: string}[]} poses W of whitened rows J = W Lᵀ: 32-bit integers in units of 2⁻³⁰, row by
 *   row, the least significant byte first, as base64
 * @property {number[]|null} prior packed
 * @property {{weight: number, rows: number[][]}[]} test A of each test pose, m
 *
 * What figures are computed from.
 * @typedef {object} Matrices
 * @property {{id: number, packed: ArrayLike<number>}[]} poses JᵀJ
 * @property {ArrayLike<number>|null} prior
 * @property {{weight: number, packed: ArrayLike<number>}[]} test AᵀA, m²
 *
 * @typedef {object} Report
 * @property {string} version
 * @property {string} title
 * @property {string[]} [notes]
 * @property {any} plan plan.json
 * @property {any} route route.json or null
 * @property {string[]} frames
 * @property {Body[]} bodies
 * @property {{name: string, instrument?: string, placement: Placement}[]} stations instrument: of several
 * @property {string[]} targets of several instruments as "tracker.P1"
 * @property {Keyframe[]} keyframes
 * @property {Column[]} columns nuisance first
 * @property {Information} information
 * @property {number[]} singular_values
 * @property {Candidates|null} candidates
 * @property {Camera[]} cameras
 * @property {number[]} [position_errors] predicted at feasible configurations, m
 * @property {CurvePoint[]} curve
 * @property {(CurvePoint|null)[]} prefix after the first, second, … pose; null where not identifiable yet
 * @property {Object<string, string>} [actuator_units]
 */
export {};
