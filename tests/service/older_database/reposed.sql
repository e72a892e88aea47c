BEGIN TRANSACTION;
CREATE TABLE drive_result(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  torque REAL, torque_standard_error REAL, weight_torque REAL, weight_torque_standard_error REAL, torque_number REAL,  power REAL) STRICT;
INSERT INTO "drive_result" VALUES(1,3.3640053514765252832e-04,NULL,3.5290118251658070779e-04,NULL,2.52670215707270329197e-01,2.01840321088591527834e-03);
INSERT INTO "drive_result" VALUES(5,104.671875,104.6875,104.703125,104.71875,104.734375,104.75);
INSERT INTO "drive_result" VALUES(9,504.671875,504.6875,504.703125,504.71875,504.734375,504.75);
INSERT INTO "drive_result" VALUES(10,704.671875,704.6875,704.703125,704.71875,704.734375,704.75);
INSERT INTO "drive_result" VALUES(11,504.671875,504.6875,504.703125,504.71875,504.734375,504.75);
INSERT INTO "drive_result" VALUES(12,704.671875,704.6875,704.703125,704.71875,704.734375,704.75);
CREATE TABLE drum_input(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  drum_diameter REAL NOT NULL, drum_length REAL NOT NULL, rotation_rate REAL NOT NULL, gravity REAL NOT NULL,  fill_fraction REAL NOT NULL, particles INTEGER NOT NULL, species INTEGER NOT NULL,  diameter REAL NOT NULL, density REAL NOT NULL,  friction REAL NOT NULL, restitution REAL NOT NULL, wall_friction REAL NOT NULL,  tangential_stiffness_ratio REAL NOT NULL, stiffness REAL NOT NULL, lining_diameter REAL NOT NULL,  time_step REAL NOT NULL, duration REAL NOT NULL, seed INTEGER NOT NULL, ends TEXT NOT NULL DEFAULT 'periodic', lifters INTEGER NOT NULL DEFAULT 0, shape TEXT NOT NULL DEFAULT 'sphere', rolling_friction REAL NOT NULL DEFAULT 0, wall_rolling_friction REAL NOT NULL DEFAULT 0) STRICT;
INSERT INTO "drum_input" VALUES(1,0.04,0.012,6.0,9.81,0.3,81,1,0.004,2500.0,0.3,0.8,0.5,0.8,3.23925003868204612438e+02,0.002,5.08375315348017905135e-05,0.4,7,'periodic',0,'sphere',0.0,0.0);
INSERT INTO "drum_input" VALUES(5,0.05,0.02,-5.23598775598298882272e+00,3.7,7.53333333333333216019e-02,60,2,0.003,1900.0,0.45,0.6,0.35,0.7,900.0,0.0,1.16041298749387040891e-05,0.6,11,'walls',4,'dumbbell',0.02,0.03);
INSERT INTO "drum_input" VALUES(9,0.05,0.02,-5.23598775598298882272e+00,3.7,7.53333333333333216019e-02,60,2,0.003,1900.0,0.1,0.6,0.35,0.7,900.0,0.0,1.16041298749387040891e-05,0.6,11,'walls',4,'dumbbell',0.02,0.03);
INSERT INTO "drum_input" VALUES(10,0.05,0.02,-5.23598775598298882272e+00,3.7,7.53333333333333216019e-02,60,2,0.003,1900.0,0.6,0.6,0.35,0.7,900.0,0.0,1.16041298749387040891e-05,0.6,11,'walls',4,'dumbbell',0.02,0.03);
INSERT INTO "drum_input" VALUES(11,0.05,0.02,-5.23598775598298882272e+00,3.7,7.53333333333333216019e-02,60,2,0.003,1900.0,0.1,0.6,0.35,0.7,900.0,0.0,1.16041298749387040891e-05,0.6,12,'walls',4,'dumbbell',0.02,0.03);
INSERT INTO "drum_input" VALUES(12,0.05,0.02,-5.23598775598298882272e+00,3.7,7.53333333333333216019e-02,60,2,0.003,1900.0,0.6,0.6,0.35,0.7,900.0,0.0,1.16041298749387040891e-05,0.6,12,'walls',4,'dumbbell',0.02,0.03);
INSERT INTO "drum_input" VALUES(13,0.04,0.012,6.0,9.81,0.3,81,1,0.004,2500.0,0.3,0.8,0.5,0.8,3.23925003868204612438e+02,0.002,5.08375315348017905135e-05,2000.0,9,'periodic',0,'sphere',0.0,0.0);
CREATE TABLE fill_input(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  cylinder_diameter REAL NOT NULL, stream_diameter REAL NOT NULL, rate REAL NOT NULL, impact_speed REAL NOT NULL,  gravity REAL NOT NULL, particles INTEGER NOT NULL, species INTEGER NOT NULL, diameter REAL NOT NULL,  density REAL NOT NULL, shape TEXT NOT NULL,  friction REAL NOT NULL, restitution REAL NOT NULL, wall_friction REAL NOT NULL,  tangential_stiffness_ratio REAL NOT NULL, stiffness REAL NOT NULL, time_step REAL NOT NULL,  duration REAL NOT NULL, seed INTEGER NOT NULL,  rolling_friction REAL NOT NULL, wall_rolling_friction REAL NOT NULL) STRICT;
INSERT INTO "fill_input" VALUES(2,0.03,0.012,300.0,0.9,9.81,120,1,0.004,2400.0,'sphere',0.2,0.8,0.4,0.8,2.54469004940773265853e+03,1.77715317526334620618e-05,2.4,3,0.0,0.0);
INSERT INTO "fill_input" VALUES(6,0.03,0.012,300.0,0.9,9.81,120,1,0.004,2400.0,'sphere',0.2,0.8,0.4,0.8,2.54469004940773265853e+03,1.77715317526334620618e-05,2.4,4,0.0,0.0);
CREATE TABLE fill_result(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  inside INTEGER, apart INTEGER, waiting INTEGER, at_rest INTEGER) STRICT;
INSERT INTO "fill_result" VALUES(2,120,0,0,1);
INSERT INTO "fill_result" VALUES(6,1002,1003,1004,0);
CREATE TABLE granule_input(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  friction REAL NOT NULL, radius REAL NOT NULL, rotation_rate REAL,  revolutions INTEGER NOT NULL, gravity REAL NOT NULL, tolerance REAL NOT NULL) STRICT;
INSERT INTO "granule_input" VALUES(4,0.5,0.063,18.0,30,9.81,1.0e-09);
INSERT INTO "granule_input" VALUES(8,0.75,0.063,NULL,30,1.6,1.0e-09);
CREATE TABLE granule_result(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  minimum_omega2 REAL, error REAL, minimum_rotation_rate REAL, slip_per_revolution REAL, slip_onset_deg REAL) STRICT;
INSERT INTO "granule_result" VALUES(4,1.82626241446669546064e+00,5.76589020890277e-10,1.68634263243128721398e+01,3.83340230669763748494e-01,-8.67622902519219785233e+00);
INSERT INTO "granule_result" VALUES(8,3000.015625,3000.03125,3000.046875,3000.0625,3000.078125);
CREATE TABLE heap_input(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  tube_diameter REAL NOT NULL, lift_speed REAL NOT NULL, plate_diameter REAL NOT NULL, rim_height REAL NOT NULL,  plate_friction REAL NOT NULL,  gravity REAL NOT NULL, particles INTEGER NOT NULL, species INTEGER NOT NULL, diameter REAL NOT NULL,  density REAL NOT NULL, shape TEXT NOT NULL,  friction REAL NOT NULL, restitution REAL NOT NULL, wall_friction REAL NOT NULL,  tangential_stiffness_ratio REAL NOT NULL, stiffness REAL NOT NULL, time_step REAL NOT NULL,  duration REAL NOT NULL, seed INTEGER NOT NULL,  rolling_friction REAL NOT NULL, wall_rolling_friction REAL NOT NULL) STRICT;
INSERT INTO "heap_input" VALUES(3,0.02,0.1,0.04,0.0015,0.6,9.81,240,1,0.003,2500.0,'sphere',0.5,0.4,0.5,0.8,3.24804023134562783073e+02,2.56474042317623652977e-05,3.17999999999999971578e+00,5,0.0,0.0);
INSERT INTO "heap_input" VALUES(7,0.02,0.1,0.04,0.0015,0.6,9.81,240,1,0.003,2500.0,'sphere',0.5,0.4,0.5,0.8,3.24804023134562783073e+02,2.56474042317623652977e-05,3.17999999999999971578e+00,6,0.0,0.0);
CREATE TABLE heap_result(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  inside INTEGER, apart INTEGER, lost INTEGER, at_rest INTEGER) STRICT;
INSERT INTO "heap_result" VALUES(3,217,8,15,1);
INSERT INTO "heap_result" VALUES(7,2002,2003,2004,0);
CREATE TABLE job(  number INTEGER PRIMARY KEY,  id TEXT NOT NULL UNIQUE,  process TEXT NOT NULL,  label TEXT NOT NULL,  spec TEXT NOT NULL,  status TEXT NOT NULL CHECK(status IN ('accepted','running','successful','failed','dismissed')),  message TEXT NOT NULL,  attempt INTEGER NOT NULL DEFAULT 1,  not_before REAL NOT NULL DEFAULT 0,  threads INTEGER NOT NULL,  estimated_seconds REAL NOT NULL,  estimated_memory_bytes REAL NOT NULL,  created TEXT NOT NULL, started TEXT, finished TEXT, updated TEXT NOT NULL,  progress REAL NOT NULL DEFAULT 0,  eta_seconds REAL,  failure TEXT, study INTEGER REFERENCES study(number), study_case INTEGER, study_repeat INTEGER, setbacks INTEGER NOT NULL DEFAULT 0, attempts_before INTEGER NOT NULL DEFAULT 0) STRICT;
INSERT INTO "job" VALUES(1,'20261130-014942-5fad2348','drum','{"paper":"figure 1","mu":0.25}','{
  "process": "drum",
  "inputs": {
    "drum": {
      "diameter": 0.04,
      "length": 0.012,
      "ends": "periodic",
      "lifters": null,
      "rotation_rate": 6.0
    },
    "particles": [
      {
        "shape": "sphere",
        "diameter": 0.004,
        "density": 2500.0,
        "share": 1.0
      }
    ],
    "share_by": "number",
    "fill_fraction": 0.3,
    "start": null,
    "contact": {
      "law": "walton-braun",
      "friction": 0.3,
      "rolling_friction": 0.0,
      "restitution": 0.8,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.8,
      "maximum_overlap": 0.05,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.5,
      "rolling_friction": 0.0,
      "lining": {
        "diameter": 0.002,
        "pitch": 0.002
      }
    },
    "duration": {
      "seconds": 0.4
    },
    "snapshots": {
      "interval": 0.0
    },
    "samples": {
      "interval": 0.05
    },
    "seed": 7,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 9.81
  },
  "label": {
    "paper": "figure 1",
    "mu": 0.25
  }
}
','successful','done',1,0.0,1,1.92310272419163652557e-01,1.62019324506661593909e+07,'2026-11-30T01:49:42.270Z','2026-11-30T01:49:42.290Z','2026-11-30T01:49:43.449Z','2026-11-30T01:49:43.449Z',100.0,NULL,NULL,NULL,NULL,NULL,0,0);
INSERT INTO "job" VALUES(2,'20261130-014942-91a372a1','fill','{"paper":"figure 1","mu":0.25}','{
  "process": "fill",
  "inputs": {
    "cylinder": {
      "diameter": 0.03
    },
    "stream": {
      "diameter": 0.012,
      "rate": 300.0,
      "impact_speed": 0.9
    },
    "particles": [
      {
        "shape": "sphere",
        "diameter": 0.004,
        "density": 2400.0,
        "share": 1.0
      }
    ],
    "share_by": "number",
    "particle_count": 120,
    "contact": {
      "law": "walton-braun",
      "friction": 0.2,
      "rolling_friction": 0.0,
      "restitution": 0.8,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.8,
      "maximum_overlap": 0.05,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.4,
      "rolling_friction": 0.0
    },
    "duration": {
      "settling_seconds": 2.0
    },
    "snapshots": {
      "interval": 0.0
    },
    "samples": {
      "interval": 0.05
    },
    "seed": 3,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 9.81
  },
  "label": {
    "paper": "figure 1",
    "mu": 0.25
  }
}
','successful','done',1,0.0,1,2.02287711315473517359e-01,15806800.0,'2026-11-30T01:49:42.339Z','2026-11-30T01:49:43.452Z','2026-11-30T01:49:44.549Z','2026-11-30T01:49:44.549Z',100.0,NULL,NULL,NULL,NULL,NULL,0,0);
INSERT INTO "job" VALUES(3,'20261130-014942-f8d41d32','heap','{"paper":"figure 1","mu":0.25}','{
  "process": "heap",
  "inputs": {
    "tube": {
      "diameter": 0.02,
      "height": 0.029399999999999996,
      "lift_speed": 0.1
    },
    "plate": {
      "diameter": 0.04,
      "rim_height": 0.0015,
      "friction": 0.6,
      "rolling_friction": 0.0
    },
    "particles": [
      {
        "shape": "sphere",
        "diameter": 0.003,
        "density": 2500.0,
        "share": 1.0
      }
    ],
    "share_by": "number",
    "particle_count": 240,
    "contact": {
      "law": "walton-braun",
      "friction": 0.5,
      "rolling_friction": 0.0,
      "restitution": 0.4,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.8,
      "maximum_overlap": 0.05,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.5,
      "rolling_friction": 0.0
    },
    "duration": {
      "at_most_seconds": 3.1799999999999997
    },
    "snapshots": {
      "interval": 0.0
    },
    "samples": {
      "interval": 0.05
    },
    "seed": 5,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 9.81
  },
  "label": {
    "paper": "figure 1",
    "mu": 0.25
  }
}
','successful','done',1,0.0,1,4.5296281143842576089e-01,15910360.0,'2026-11-30T01:49:42.383Z','2026-11-30T01:49:44.561Z','2026-11-30T01:49:46.166Z','2026-11-30T01:49:46.166Z',100.0,NULL,NULL,NULL,NULL,NULL,0,0);
INSERT INTO "job" VALUES(4,'20261130-014942-595ab0e7','granule','{"paper":"figure 1","mu":0.25}','{
  "process": "granule",
  "inputs": {
    "friction": 0.5,
    "radius": 0.063,
    "rotation_rate": 18.0,
    "revolutions": 30,
    "gravity": 9.81,
    "tolerance": 1e-09
  },
  "label": {
    "paper": "figure 1",
    "mu": 0.25
  }
}
','successful','done',1,0.0,1,0.05,20000000.0,'2026-11-30T01:49:42.411Z','2026-11-30T01:49:46.176Z','2026-11-30T01:49:46.877Z','2026-11-30T01:49:46.877Z',100.0,NULL,NULL,NULL,NULL,NULL,0,0);
INSERT INTO "job" VALUES(5,'20261130-014942-32747067','drum','{"made":100}','{
  "process": "drum",
  "inputs": {
    "drum": {
      "diameter": 0.05,
      "length": 0.02,
      "ends": "walls",
      "lifters": {
        "count": 4,
        "height": 0.003,
        "width": 0.002,
        "friction": 0.35
      },
      "rotation_rate": -5.235987755982989
    },
    "particles": [
      {
        "shape": "dumbbell",
        "diameter": 0.003,
        "density": 1900.0,
        "share": 0.75
      },
      {
        "shape": "sphere",
        "diameter": 0.004,
        "density": 2500.0,
        "share": 0.25
      }
    ],
    "share_by": "number",
    "particle_count": 60,
    "start": null,
    "contact": {
      "law": "walton-braun",
      "friction": 0.45,
      "rolling_friction": 0.02,
      "restitution": 0.6,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.7,
      "stiffness": 900.0,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.35,
      "rolling_friction": 0.03,
      "end_friction": 0.35,
      "lining": null
    },
    "duration": {
      "revolutions": 0.5
    },
    "snapshots": {
      "interval": 0.1
    },
    "samples": {
      "interval": 0.009375
    },
    "seed": 11,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 3.7
  },
  "label": {
    "made": 100
  }
}
','successful','done, with 2 warnings: /run/seed is odd',1,0.0,1,5.90093352421941830243e-01,1.60244640200118664647e+07,'2026-11-30T01:49:42.422Z','2026-11-30T01:49:46.879Z','2026-11-30T01:49:47.311Z','2026-11-30T01:49:47.311Z',100.0,NULL,NULL,NULL,NULL,NULL,0,0);
INSERT INTO "job" VALUES(6,'20261130-014942-8aaa7e13','fill','{"made":1000}','{
  "process": "fill",
  "inputs": {
    "cylinder": {
      "diameter": 0.03
    },
    "stream": {
      "diameter": 0.012,
      "rate": 300.0,
      "impact_speed": 0.9
    },
    "particles": [
      {
        "shape": "sphere",
        "diameter": 0.004,
        "density": 2400.0,
        "share": 1.0
      }
    ],
    "share_by": "number",
    "particle_count": 120,
    "contact": {
      "law": "walton-braun",
      "friction": 0.2,
      "rolling_friction": 0.0,
      "restitution": 0.8,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.8,
      "maximum_overlap": 0.05,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.4,
      "rolling_friction": 0.0
    },
    "duration": {
      "settling_seconds": 2.0
    },
    "snapshots": {
      "interval": 0.0
    },
    "samples": {
      "interval": 0.05
    },
    "seed": 4,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 9.81
  },
  "label": {
    "made": 1000
  }
}
','successful','done, with 2 warnings: /run/seed is odd',1,0.0,1,2.02287711315473517359e-01,15806800.0,'2026-11-30T01:49:42.447Z','2026-11-30T01:49:47.330Z','2026-11-30T01:49:47.892Z','2026-11-30T01:49:47.892Z',100.0,NULL,NULL,NULL,NULL,NULL,0,0);
INSERT INTO "job" VALUES(7,'20261130-014942-531844cc','heap','{"made":2000}','{
  "process": "heap",
  "inputs": {
    "tube": {
      "diameter": 0.02,
      "height": 0.029399999999999996,
      "lift_speed": 0.1
    },
    "plate": {
      "diameter": 0.04,
      "rim_height": 0.0015,
      "friction": 0.6,
      "rolling_friction": 0.0
    },
    "particles": [
      {
        "shape": "sphere",
        "diameter": 0.003,
        "density": 2500.0,
        "share": 1.0
      }
    ],
    "share_by": "number",
    "particle_count": 240,
    "contact": {
      "law": "walton-braun",
      "friction": 0.5,
      "rolling_friction": 0.0,
      "restitution": 0.4,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.8,
      "maximum_overlap": 0.05,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.5,
      "rolling_friction": 0.0
    },
    "duration": {
      "at_most_seconds": 3.1799999999999997
    },
    "snapshots": {
      "interval": 0.0
    },
    "samples": {
      "interval": 0.05
    },
    "seed": 6,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 9.81
  },
  "label": {
    "made": 2000
  }
}
','successful','done, with 2 warnings: /run/seed is odd',1,0.0,1,4.5296281143842576089e-01,15910360.0,'2026-11-30T01:49:42.458Z','2026-11-30T01:49:47.899Z','2026-11-30T01:49:48.560Z','2026-11-30T01:49:48.560Z',100.0,NULL,NULL,NULL,NULL,NULL,0,0);
INSERT INTO "job" VALUES(8,'20261130-014942-fabba358','granule','{"made":3000}','{
  "process": "granule",
  "inputs": {
    "friction": 0.75,
    "radius": 0.063,
    "revolutions": 30,
    "gravity": 1.6,
    "tolerance": 1e-09
  },
  "label": {
    "made": 3000
  }
}
','successful','done, with 2 warnings: /run/seed is odd',1,0.0,1,0.05,20000000.0,'2026-11-30T01:49:42.522Z','2026-11-30T01:49:48.572Z','2026-11-30T01:49:49.350Z','2026-11-30T01:49:49.350Z',100.0,NULL,NULL,NULL,NULL,NULL,0,0);
INSERT INTO "job" VALUES(9,'20261130-014942-6f825b89','drum','{"made":500,"study":"friction of a drum","case":"smooth"}','{
  "process": "drum",
  "inputs": {
    "drum": {
      "diameter": 0.05,
      "length": 0.02,
      "ends": "walls",
      "lifters": {
        "count": 4,
        "height": 0.003,
        "width": 0.002,
        "friction": 0.35
      },
      "rotation_rate": -5.235987755982989
    },
    "particles": [
      {
        "shape": "dumbbell",
        "diameter": 0.003,
        "density": 1900.0,
        "share": 0.75
      },
      {
        "shape": "sphere",
        "diameter": 0.004,
        "density": 2500.0,
        "share": 0.25
      }
    ],
    "share_by": "number",
    "particle_count": 60,
    "start": null,
    "contact": {
      "law": "walton-braun",
      "friction": 0.1,
      "rolling_friction": 0.02,
      "restitution": 0.6,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.7,
      "stiffness": 900.0,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.35,
      "rolling_friction": 0.03,
      "end_friction": 0.35,
      "lining": null
    },
    "duration": {
      "revolutions": 0.5
    },
    "snapshots": {
      "interval": 0.1
    },
    "samples": {
      "interval": 0.009375
    },
    "seed": 11,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 3.7
  },
  "label": {
    "made": 500,
    "study": "friction of a drum",
    "case": "smooth"
  }
}
','successful','done, with 2 warnings: /run/seed is odd',1,0.0,1,6.25517938319713806549e-01,1.60244640200118664647e+07,'2026-11-30T01:49:42.576Z','2026-11-30T01:49:49.362Z','2026-11-30T01:49:49.991Z','2026-11-30T01:49:49.991Z',100.0,NULL,NULL,1,0,0,0,0);
INSERT INTO "job" VALUES(10,'20261130-014942-6f825b8a','drum','{"made":700,"study":"friction of a drum","case":"rough"}','{
  "process": "drum",
  "inputs": {
    "drum": {
      "diameter": 0.05,
      "length": 0.02,
      "ends": "walls",
      "lifters": {
        "count": 4,
        "height": 0.003,
        "width": 0.002,
        "friction": 0.35
      },
      "rotation_rate": -5.235987755982989
    },
    "particles": [
      {
        "shape": "dumbbell",
        "diameter": 0.003,
        "density": 1900.0,
        "share": 0.75
      },
      {
        "shape": "sphere",
        "diameter": 0.004,
        "density": 2500.0,
        "share": 0.25
      }
    ],
    "share_by": "number",
    "particle_count": 60,
    "start": null,
    "contact": {
      "law": "walton-braun",
      "friction": 0.6,
      "rolling_friction": 0.02,
      "restitution": 0.6,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.7,
      "stiffness": 900.0,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.35,
      "rolling_friction": 0.03,
      "end_friction": 0.35,
      "lining": null
    },
    "duration": {
      "revolutions": 0.5
    },
    "snapshots": {
      "interval": 0.1
    },
    "samples": {
      "interval": 0.009375
    },
    "seed": 11,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 3.7
  },
  "label": {
    "made": 700,
    "study": "friction of a drum",
    "case": "rough"
  }
}
','successful','done, with 2 warnings: /run/seed is odd',1,0.0,1,5.83317758088392479542e-01,1.60244640200118664647e+07,'2026-11-30T01:49:42.576Z','2026-11-30T01:49:50.002Z','2026-11-30T01:49:50.568Z','2026-11-30T01:49:50.568Z',100.0,NULL,NULL,1,1,0,0,0);
INSERT INTO "job" VALUES(11,'20261130-014942-6f825b8b','drum','{"made":500,"study":"friction of a drum","case":"smooth"}','{
  "process": "drum",
  "inputs": {
    "drum": {
      "diameter": 0.05,
      "length": 0.02,
      "ends": "walls",
      "lifters": {
        "count": 4,
        "height": 0.003,
        "width": 0.002,
        "friction": 0.35
      },
      "rotation_rate": -5.235987755982989
    },
    "particles": [
      {
        "shape": "dumbbell",
        "diameter": 0.003,
        "density": 1900.0,
        "share": 0.75
      },
      {
        "shape": "sphere",
        "diameter": 0.004,
        "density": 2500.0,
        "share": 0.25
      }
    ],
    "share_by": "number",
    "particle_count": 60,
    "start": null,
    "contact": {
      "law": "walton-braun",
      "friction": 0.1,
      "rolling_friction": 0.02,
      "restitution": 0.6,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.7,
      "stiffness": 900.0,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.35,
      "rolling_friction": 0.03,
      "end_friction": 0.35,
      "lining": null
    },
    "duration": {
      "revolutions": 0.5
    },
    "snapshots": {
      "interval": 0.1
    },
    "samples": {
      "interval": 0.009375
    },
    "seed": 12,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 3.7
  },
  "label": {
    "made": 500,
    "study": "friction of a drum",
    "case": "smooth"
  }
}
','successful','done, with 2 warnings: /run/seed is odd',1,0.0,1,6.25517938319713806549e-01,1.60244640200118664647e+07,'2026-11-30T01:49:42.576Z','2026-11-30T01:49:50.583Z','2026-11-30T01:49:51.253Z','2026-11-30T01:49:51.253Z',100.0,NULL,NULL,1,0,1,0,0);
INSERT INTO "job" VALUES(12,'20261130-014942-6f825b8c','drum','{"made":700,"study":"friction of a drum","case":"rough"}','{
  "process": "drum",
  "inputs": {
    "drum": {
      "diameter": 0.05,
      "length": 0.02,
      "ends": "walls",
      "lifters": {
        "count": 4,
        "height": 0.003,
        "width": 0.002,
        "friction": 0.35
      },
      "rotation_rate": -5.235987755982989
    },
    "particles": [
      {
        "shape": "dumbbell",
        "diameter": 0.003,
        "density": 1900.0,
        "share": 0.75
      },
      {
        "shape": "sphere",
        "diameter": 0.004,
        "density": 2500.0,
        "share": 0.25
      }
    ],
    "share_by": "number",
    "particle_count": 60,
    "start": null,
    "contact": {
      "law": "walton-braun",
      "friction": 0.6,
      "rolling_friction": 0.02,
      "restitution": 0.6,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.7,
      "stiffness": 900.0,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.35,
      "rolling_friction": 0.03,
      "end_friction": 0.35,
      "lining": null
    },
    "duration": {
      "revolutions": 0.5
    },
    "snapshots": {
      "interval": 0.1
    },
    "samples": {
      "interval": 0.009375
    },
    "seed": 12,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 3.7
  },
  "label": {
    "made": 700,
    "study": "friction of a drum",
    "case": "rough"
  }
}
','successful','done, with 2 warnings: /run/seed is odd',1,0.0,1,5.83317758088392479542e-01,1.60244640200118664647e+07,'2026-11-30T01:49:42.576Z','2026-11-30T01:49:51.284Z','2026-11-30T01:49:51.824Z','2026-11-30T01:49:51.824Z',100.0,NULL,NULL,1,1,1,0,0);
INSERT INTO "job" VALUES(13,'20261130-014951-724323b5','drum','{}','{
  "process": "drum",
  "inputs": {
    "drum": {
      "diameter": 0.04,
      "length": 0.012,
      "ends": "periodic",
      "lifters": null,
      "rotation_rate": 6.0
    },
    "particles": [
      {
        "shape": "sphere",
        "diameter": 0.004,
        "density": 2500.0,
        "share": 1.0
      }
    ],
    "share_by": "number",
    "fill_fraction": 0.3,
    "start": null,
    "contact": {
      "law": "walton-braun",
      "friction": 0.3,
      "rolling_friction": 0.0,
      "restitution": 0.8,
      "unloading": "constant",
      "latch_damping": 0.3,
      "tangential_stiffness_ratio": 0.8,
      "maximum_overlap": 0.05,
      "poissons_ratio": 0.3
    },
    "wall": {
      "friction": 0.5,
      "rolling_friction": 0.0,
      "lining": {
        "diameter": 0.002,
        "pitch": 0.002
      }
    },
    "duration": {
      "seconds": 2000.0
    },
    "snapshots": {
      "interval": 0.0
    },
    "samples": {
      "interval": 0.05
    },
    "seed": 9,
    "threads": 1,
    "integration": {
      "corrector_passes": 1
    },
    "precision": "single",
    "gravity": 9.81
  },
  "label": {}
}
','dismissed','dismissed on request',1,0.0,1,1.61112050505046522632e+03,3.53980924506661593915e+07,'2026-11-30T01:49:51.870Z','2026-11-30T01:49:51.886Z','2026-11-30T01:49:52.214Z','2026-11-30T01:49:52.214Z',0.0,NULL,NULL,NULL,NULL,NULL,0,0);
CREATE TABLE job_count(status TEXT PRIMARY KEY, jobs INTEGER NOT NULL) STRICT, WITHOUT ROWID;
INSERT INTO "job_count" VALUES('accepted',0);
INSERT INTO "job_count" VALUES('dismissed',1);
INSERT INTO "job_count" VALUES('failed',0);
INSERT INTO "job_count" VALUES('running',0);
INSERT INTO "job_count" VALUES('successful',12);
CREATE TABLE job_load(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  spheres REAL NOT NULL, of_particle REAL NOT NULL, law INTEGER NOT NULL, friction REAL NOT NULL,  rolling_friction INTEGER NOT NULL, in_double INTEGER NOT NULL, threads INTEGER NOT NULL, factor REAL NOT NULL) STRICT;
INSERT INTO "job_load" VALUES(1,4.5799111843077520232e+02,1.0,0,0.3,0,0,1,1.40627261363534850069e+00);
INSERT INTO "job_load" VALUES(2,9.00000000000000142073e+01,1.0,0,0.2,0,0,1,1.53212851559839480231e+00);
INSERT INTO "job_load" VALUES(3,240.0,1.0,0,0.5,0,0,1,2.30530158187351652543e+00);
INSERT INTO "job_load" VALUES(5,105.0,1.75,0,0.45,1,0,1,1.16414765488964566664e+00);
INSERT INTO "job_load" VALUES(6,9.00000000000000142073e+01,1.0,0,0.2,0,0,1,1.53212851559839480231e+00);
INSERT INTO "job_load" VALUES(7,240.0,1.0,0,0.5,0,0,1,2.30530158187351652543e+00);
INSERT INTO "job_load" VALUES(9,105.0,1.75,0,0.1,1,0,1,1.15342532466156666437e+00);
INSERT INTO "job_load" VALUES(10,105.0,1.75,0,0.6,1,0,1,1.16637154742746029789e+00);
INSERT INTO "job_load" VALUES(11,105.0,1.75,0,0.1,1,0,1,1.15342532466156666437e+00);
INSERT INTO "job_load" VALUES(12,105.0,1.75,0,0.6,1,0,1,1.16637154742746029789e+00);
INSERT INTO "job_load" VALUES(13,4.5799111843077520232e+02,1.0,0,0.3,0,0,1,1.01114338108418766459e+00);
CREATE TABLE last_deleted(number INTEGER NOT NULL) STRICT;
INSERT INTO "last_deleted" VALUES(0);
CREATE TABLE leaving(id TEXT PRIMARY KEY, since REAL NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE packing_result(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  solid_fraction REAL, coordination_number REAL, mean_overlap REAL, overlap_99 REAL) STRICT;
INSERT INTO "packing_result" VALUES(1,0.566196002017629,3.08230452674897081877e+00,2.61301093398552111354e-03,0.00949907185659017);
INSERT INTO "packing_result" VALUES(2,NULL,4.675,NULL,NULL);
INSERT INTO "packing_result" VALUES(3,6.8282213616246179022e-01,4.20276497695852491176e+00,NULL,NULL);
INSERT INTO "packing_result" VALUES(5,104.609375,104.625,104.640625,104.65625);
INSERT INTO "packing_result" VALUES(6,1001.1875,1001.203125,NULL,NULL);
INSERT INTO "packing_result" VALUES(7,2001.140625,2001.15625,NULL,NULL);
INSERT INTO "packing_result" VALUES(9,504.609375,504.625,504.640625,504.65625);
INSERT INTO "packing_result" VALUES(10,704.609375,704.625,704.640625,704.65625);
INSERT INTO "packing_result" VALUES(11,504.609375,504.625,504.640625,504.65625);
INSERT INTO "packing_result" VALUES(12,704.609375,704.625,704.640625,704.65625);
CREATE TABLE regime_result(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  name TEXT, omega2_outer REAL, omega2_inner REAL, certain INTEGER) STRICT;
INSERT INTO "regime_result" VALUES(1,'avalanching',7.33944954128440268936e-02,6.1406240479565180057e-02,0);
INSERT INTO "regime_result" VALUES(4,'sliding',2.0807339449541282228e+00,NULL,NULL);
INSERT INTO "regime_result" VALUES(5,'slumping',104.34375,104.359375,1);
INSERT INTO "regime_result" VALUES(8,'slumping',3000.1875,NULL,NULL);
INSERT INTO "regime_result" VALUES(9,'slumping',504.34375,504.359375,1);
INSERT INTO "regime_result" VALUES(10,'slumping',704.34375,704.359375,1);
INSERT INTO "regime_result" VALUES(11,'slumping',504.34375,504.359375,1);
INSERT INTO "regime_result" VALUES(12,'slumping',704.34375,704.359375,1);
CREATE TABLE repose_result(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  angle_deg REAL, standard_error_deg REAL, minimum_deg REAL, maximum_deg REAL, steady INTEGER,  drift_deg_per_revolution REAL, method TEXT, interface_fluctuation REAL, slumps_count INTEGER, slumps_period REAL, slumps_start_deg REAL, slumps_stop_deg REAL, slumps_size_deg REAL, while_filling_angle_deg REAL, while_filling_standard_error_deg REAL, verdict TEXT, drift_bound_deg_per_revolution REAL, window_revolutions REAL, window_correlation_times REAL, layers REAL) STRICT;
INSERT INTO "repose_result" VALUES(1,3.20143576728625802721e+01,NULL,2.02366926040522301369e+01,4.11139410230754549519e+01,NULL,-3.96881110774265621898e+01,'surface-fit',1.60463057057708526412e-03,0,NULL,NULL,NULL,NULL,NULL,NULL,'too-few',1.53907022011995877619e+02,2.38701993020314223725e-01,6.0,3.401542451047480764e+00);
INSERT INTO "repose_result" VALUES(2,3.8589752304980189379e+00,5.85544229451348297033e+00,-1.55391291538149527444e+01,2.71714003346050887439e+01,NULL,NULL,'radial-fit',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "repose_result" VALUES(3,2.19737011624350522245e+01,1.21327893488723637105e+00,1.55737727280645756877e+01,3.29603878550378226464e+01,NULL,NULL,'azimuthal-fit',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "repose_result" VALUES(5,100.015625,100.03125,100.046875,100.0625,0,101.078125,'surface-fit',101.109375,103,103.21875,103.25,103.28125,103.3125,NULL,NULL,'drifting',101.09375,101.15625,101.171875,102.203125);
INSERT INTO "repose_result" VALUES(6,1000.015625,1000.03125,1000.046875,1000.0625,NULL,NULL,'surface-fit',NULL,NULL,NULL,NULL,NULL,NULL,1001.078125,1001.09375,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "repose_result" VALUES(7,2000.015625,2000.03125,2000.046875,2000.0625,NULL,NULL,'surface-fit',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "repose_result" VALUES(9,500.015625,500.03125,500.046875,500.0625,0,501.078125,'surface-fit',501.109375,503,503.21875,503.25,503.28125,503.3125,NULL,NULL,'drifting',501.09375,501.15625,501.171875,502.203125);
INSERT INTO "repose_result" VALUES(10,700.015625,700.03125,700.046875,700.0625,0,701.078125,'surface-fit',701.109375,703,703.21875,703.25,703.28125,703.3125,NULL,NULL,'drifting',701.09375,701.15625,701.171875,702.203125);
INSERT INTO "repose_result" VALUES(11,500.015625,500.03125,500.046875,500.0625,0,501.078125,'surface-fit',501.109375,503,503.21875,503.25,503.28125,503.3125,NULL,NULL,'drifting',501.09375,501.15625,501.171875,502.203125);
INSERT INTO "repose_result" VALUES(12,700.015625,700.03125,700.046875,700.0625,0,701.078125,'surface-fit',701.109375,703,703.21875,703.25,703.28125,703.3125,NULL,NULL,'drifting',701.09375,701.15625,701.171875,702.203125);
CREATE TABLE result(job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE, document TEXT NOT NULL) STRICT;
INSERT INTO "result" VALUES(1,'{
  "repose": {
    "angle_deg": 32.01435767286258,
    "standard_error_deg": null,
    "minimum_deg": 20.23669260405223,
    "maximum_deg": 41.113941023075455,
    "steady": null,
    "verdict": "too-few",
    "drift_deg_per_revolution": -39.68811107742656,
    "drift_bound_deg_per_revolution": 153.90702201199588,
    "interface_fluctuation": 0.0016046305705770853,
    "window": {
      "start": 0.15002155555920008,
      "end": 0.39998969811582047,
      "revolutions": 0.23870199302031422,
      "correlation_times": 6.0
    },
    "correlation_time": 0.04999362851132408,
    "frames": 6,
    "layers": 3.4015424510474808,
    "slumps": {
      "count": 0,
      "period": null,
      "period_standard_error": null,
      "start_deg": null,
      "start_standard_error_deg": null,
      "stop_deg": null,
      "stop_standard_error_deg": null,
      "size_deg": null,
      "size_standard_error_deg": null
    },
    "method": "surface-fit",
    "other_methods": {
      "center-of-mass": 34.63485996496218,
      "chord": 31.574419073320716,
      "theil-sen": 30.98401510543479,
      "upper-chord": 32.553511773563,
      "lower-chord": 36.202214724460006
    },
    "other_methods_standard_error_deg": {
      "center-of-mass": null,
      "chord": null,
      "theil-sen": null,
      "upper-chord": null,
      "lower-chord": null
    }
  },
  "regime": {
    "certain": false,
    "omega2_outer": 0.07339449541284403,
    "omega2_inner": 0.06140624047956518,
    "predicted": {
      "stationary_eq33": 1.8863235098420905,
      "sliding_eq35": 1.6496420597188493,
      "sliding_eq36": 1.6192231481064165
    },
    "evidence": {
      "wall_slip": null,
      "wall_slip_fluctuation": null,
      "angle_fluctuation_deg": 5.826912175897604,
      "flow_fluctuation": 0.7798783140307555,
      "airborne_fraction": 0.0,
      "wall_coverage": 0.23842592592592593,
      "curvature_deg": -3.648702950897004,
      "fallen_fraction": 0.37037037037037035,
      "surface_lag": 2.3256446959011083
    },
    "name": "avalanching"
  },
  "segregation": {
    "radial_index": null,
    "axial_index": null,
    "lacey_index": null
  },
  "packing": {
    "solid_fraction": 0.566196002017629,
    "coordination_number": 3.082304526748971,
    "mean_overlap": 0.002613010933985521,
    "overlap_99": 0.00949907185659017
  },
  "drive": {
    "torque": 0.00033640053514765253,
    "torque_standard_error": null,
    "weight_torque": 0.0003529011825165807,
    "weight_torque_standard_error": null,
    "torque_number": 0.25267021570727033,
    "power": 0.0020184032108859153
  },
  "run": {
    "particles": 81,
    "spheres": 81,
    "steps": 12057,
    "time_step": 5.083753153480179e-05,
    "simulated_seconds": 0.39998969811582047,
    "settling_seconds": 0.2129584195992847,
    "wall_seconds": 0.37978258800103504,
    "particle_steps_per_second": 2571515.995876405,
    "maximum_overlap": 0.0384879513058015,
    "stiffness": 323.9250038682046,
    "fill_fraction": 0.3,
    "samples": 9,
    "snapshots": 1,
    "threads": 1,
    "isa": "avx512",
    "precision": "single",
    "seed": 7,
    "ended_by": "duration",
    "attempt": 1,
    "warnings": []
  }
}
');
INSERT INTO "result" VALUES(2,'{
  "repose": {
    "angle_deg": 3.858975230498019,
    "standard_error_deg": 5.855442294513483,
    "minimum_deg": -15.539129153814953,
    "maximum_deg": 27.17140033460509,
    "azimuths": 16,
    "while_filling": {
      "angle_deg": null,
      "standard_error_deg": null,
      "minimum_deg": null,
      "maximum_deg": null
    },
    "method": "radial-fit",
    "other_methods": {
      "center-to-wall": 0.7280628318191844,
      "area-fit": 2.1247682484145995
    },
    "other_methods_standard_error_deg": {
      "center-to-wall": null,
      "area-fit": null
    }
  },
  "surface": {
    "height": 0.009026020048922003,
    "center_height": 0.00910860360464605,
    "wall_height": 0.008974193225257974,
    "profile": {
      "radius": [
        0.0021666666666666666,
        0.0065,
        0.010833333333333334
      ],
      "height": [
        0.009153039149896784,
        0.009182783537809817,
        0.008910452092774922
      ],
      "standard_error": [
        0.00033248090738558476,
        0.0002605216129120661,
        0.00023219751287260955
      ]
    }
  },
  "packing": {
    "solid_fraction": null,
    "coordination_number": 4.675,
    "profile": {
      "height": [
        0.0019999999999999996,
        0.005999999999999998,
        0.009999999999999998,
        0.013999999999999997
      ],
      "solid_fraction": [
        0.5455556332930248,
        0.5648148952965798,
        0.31111115544205775,
        0.0007407408462906377
      ]
    }
  },
  "fill": {
    "inside": 120,
    "apart": 0,
    "waiting": 0,
    "at_rest": true
  },
  "run": {
    "particles": 120,
    "spheres": 120,
    "steps": 39389,
    "time_step": 1.7771531752633462e-05,
    "simulated_seconds": 0.7000028642044794,
    "settling_seconds": 0.0,
    "wall_seconds": 0.41457281399925705,
    "particle_steps_per_second": 11401326.47484326,
    "maximum_overlap": 0.04414680160560004,
    "stiffness": 2544.6900494077327,
    "samples": 15,
    "snapshots": 1,
    "threads": 1,
    "isa": "avx512",
    "precision": "single",
    "seed": 3,
    "ended_by": "at-rest",
    "attempt": 1,
    "warnings": []
  }
}
');
INSERT INTO "result" VALUES(3,'{
  "repose": {
    "angle_deg": 21.973701162435052,
    "standard_error_deg": 1.2132789348872364,
    "minimum_deg": 15.573772728064576,
    "maximum_deg": 32.96038785503782,
    "azimuths": 16,
    "method": "azimuthal-fit",
    "other_methods": {
      "apex-to-base": 18.377663112074103,
      "equal-volume-cone": 18.433592309739353,
      "silhouette": 24.183448224520017
    },
    "other_methods_standard_error_deg": {
      "apex-to-base": null,
      "equal-volume-cone": null,
      "silhouette": null
    }
  },
  "surface": {
    "height": 0.007988311227651729,
    "base_diameter": 0.03914692535144588,
    "volume": 4.492773657675807e-06,
    "static_cohesive_index": 0.0007915275359239913,
    "profile": {
      "radius": [
        0.0016666666666666668,
        0.005,
        0.008333333333333333,
        0.011666666666666667,
        0.015000000000000001,
        0.018333333333333333
      ],
      "height": [
        0.004471298742910037,
        0.004616655170106079,
        0.004781043847249092,
        0.004368525105348134,
        0.0035201880582126136,
        0.0021905095240330403
      ],
      "standard_error": [
        0.00030189854752821324,
        0.000243705683411576,
        0.00027430546875980693,
        0.00022958959960623848,
        0.00017715528557399007,
        0.00022435587875050124
      ]
    }
  },
  "packing": {
    "solid_fraction": 0.6828221361624618,
    "coordination_number": 4.202764976958525
  },
  "heap": {
    "inside": 217,
    "apart": 8,
    "lost": 15,
    "at_rest": true
  },
  "run": {
    "particles": 240,
    "spheres": 240,
    "steps": 25882,
    "time_step": 2.5647404231762365e-05,
    "simulated_seconds": 0.45000935465050246,
    "settling_seconds": 0.2137967616759711,
    "wall_seconds": 0.7306410599994706,
    "particle_steps_per_second": 8501684.808138898,
    "maximum_overlap": 0.03369049683109736,
    "stiffness": 324.8040231345628,
    "samples": 10,
    "snapshots": 1,
    "threads": 1,
    "isa": "avx512",
    "precision": "single",
    "seed": 5,
    "ended_by": "at-rest",
    "attempt": 1,
    "warnings": []
  }
}
');
INSERT INTO "result" VALUES(4,'{
  "granule": {
    "minimum_omega2": 1.8262624144666955,
    "error": 5.76589020890277e-10,
    "minimum_rotation_rate": 16.863426324312872,
    "slip_per_revolution": 0.38334023066976375,
    "slip_onset_deg": -8.676229025192198,
    "fits": {
      "stationary_eq33": 2.23606797749979,
      "sliding_eq34": 1.8384776310850237,
      "sliding_eq36": 1.8154019152424434
    },
    "deviations": {
      "stationary_eq33": 0.22439577126859156,
      "sliding_eq34": 0.00668864261869806,
      "sliding_eq36": -0.005946844844541999
    }
  },
  "regime": {
    "name": "sliding",
    "omega2_outer": 2.0807339449541282,
    "evidence": {
      "keeps_contact": true,
      "goes_round": true,
      "revolutions": 1,
      "slip_per_revolution": 0.013524524320549958,
      "slip_onset_deg": 5.083027236070316,
      "least_normal_force": 1.0623047798843779
    }
  },
  "run": {
    "particles": 1,
    "wall_seconds": 0.011266235000221059,
    "threads": 1,
    "attempt": 1,
    "warnings": []
  }
}
');
INSERT INTO "result" VALUES(5,'{"repose": {"method": "surface-fit", "other_methods": {}, "other_methods_standard_error_deg": {}, "angle_deg": 100.015625, "standard_error_deg": 100.03125, "minimum_deg": 100.046875, "maximum_deg": 100.0625, "steady": false, "verdict": "drifting", "drift_deg_per_revolution": 101.078125, "drift_bound_deg_per_revolution": 101.09375, "interface_fluctuation": 101.109375, "window": {"start": 101.125, "end": 101.140625, "revolutions": 101.15625, "correlation_times": 101.171875}, "correlation_time": 101.1875, "frames": 102, "layers": 102.203125, "slumps": {"count": 103, "period": 103.21875, "period_standard_error": 103.234375, "start_deg": 103.25, "start_standard_error_deg": 103.265625, "stop_deg": 103.28125, "stop_standard_error_deg": 103.296875, "size_deg": 103.3125, "size_standard_error_deg": 103.328125}}, "regime": {"name": "slumping", "certain": true, "omega2_outer": 104.34375, "omega2_inner": 104.359375, "predicted": {"stationary_eq33": 104.375, "sliding_eq35": 104.390625, "sliding_eq36": 104.40625}, "evidence": {"wall_slip": 104.421875, "wall_slip_fluctuation": 104.4375, "angle_fluctuation_deg": 104.453125, "flow_fluctuation": 104.46875, "airborne_fraction": 104.484375, "wall_coverage": 104.5, "curvature_deg": 104.515625, "fallen_fraction": 104.53125, "surface_lag": 104.546875}}, "segregation": {"radial_index": 104.5625, "axial_index": 104.578125, "lacey_index": 104.59375}, "packing": {"solid_fraction": 104.609375, "coordination_number": 104.625, "mean_overlap": 104.640625, "overlap_99": 104.65625}, "drive": {"torque": 104.671875, "torque_standard_error": 104.6875, "weight_torque": 104.703125, "weight_torque_standard_error": 104.71875, "torque_number": 104.734375, "power": 104.75}, "run": {"particles": 105, "spheres": 106, "steps": 107, "time_step": 107.765625, "simulated_seconds": 107.78125, "settling_seconds": 107.796875, "wall_seconds": 107.8125, "particle_steps_per_second": 107.828125, "maximum_overlap": 107.84375, "stiffness": 107.859375, "fill_fraction": 107.875, "samples": 108, "snapshots": 109, "threads": 110, "isa": "avx2", "precision": "double", "seed": 111, "ended_by": "duration", "attempt": 112, "warnings": [{"field": "/run/seed", "text": "is odd"}, {"field": "/run/steps", "text": "are few"}]}}');
INSERT INTO "result" VALUES(6,'{"repose": {"method": "surface-fit", "other_methods": {}, "other_methods_standard_error_deg": {}, "angle_deg": 1000.015625, "standard_error_deg": 1000.03125, "minimum_deg": 1000.046875, "maximum_deg": 1000.0625, "azimuths": 1001, "while_filling": {"angle_deg": 1001.078125, "standard_error_deg": 1001.09375, "minimum_deg": 1001.109375, "maximum_deg": 1001.125}}, "surface": {"profile": {}, "height": 1001.140625, "center_height": 1001.15625, "wall_height": 1001.171875}, "packing": {"profile": {}, "solid_fraction": 1001.1875, "coordination_number": 1001.203125}, "fill": {"inside": 1002, "apart": 1003, "waiting": 1004, "at_rest": false}, "run": {"particles": 1006, "spheres": 1007, "steps": 1008, "time_step": 1008.21875, "simulated_seconds": 1008.234375, "settling_seconds": 1008.25, "wall_seconds": 1008.265625, "particle_steps_per_second": 1008.28125, "maximum_overlap": 1008.296875, "stiffness": 1008.3125, "samples": 1009, "snapshots": 1010, "threads": 1011, "isa": "avx2", "precision": "double", "seed": 1012, "ended_by": "duration", "attempt": 1013, "warnings": [{"field": "/run/seed", "text": "is odd"}, {"field": "/run/steps", "text": "are few"}]}}');
INSERT INTO "result" VALUES(7,'{"repose": {"method": "surface-fit", "other_methods": {}, "other_methods_standard_error_deg": {}, "angle_deg": 2000.015625, "standard_error_deg": 2000.03125, "minimum_deg": 2000.046875, "maximum_deg": 2000.0625, "azimuths": 2001}, "surface": {"profile": {}, "height": 2001.078125, "base_diameter": 2001.09375, "volume": 2001.109375, "static_cohesive_index": 2001.125}, "packing": {"solid_fraction": 2001.140625, "coordination_number": 2001.15625}, "heap": {"inside": 2002, "apart": 2003, "lost": 2004, "at_rest": false}, "run": {"particles": 2006, "spheres": 2007, "steps": 2008, "time_step": 2008.171875, "simulated_seconds": 2008.1875, "settling_seconds": 2008.203125, "wall_seconds": 2008.21875, "particle_steps_per_second": 2008.234375, "maximum_overlap": 2008.25, "stiffness": 2008.265625, "samples": 2009, "snapshots": 2010, "threads": 2011, "isa": "avx2", "precision": "double", "seed": 2012, "ended_by": "duration", "attempt": 2013, "warnings": [{"field": "/run/seed", "text": "is odd"}, {"field": "/run/steps", "text": "are few"}]}}');
INSERT INTO "result" VALUES(8,'{"granule": {"minimum_omega2": 3000.015625, "error": 3000.03125, "minimum_rotation_rate": 3000.046875, "slip_per_revolution": 3000.0625, "slip_onset_deg": 3000.078125, "fits": {"stationary_eq33": 3000.09375, "sliding_eq34": 3000.109375, "sliding_eq36": 3000.125}, "deviations": {"stationary_eq33": 3000.140625, "sliding_eq34": 3000.15625, "sliding_eq36": 3000.171875}}, "regime": {"name": "slumping", "omega2_outer": 3000.1875, "evidence": {"keeps_contact": false, "goes_round": true, "revolutions": 3003, "slip_per_revolution": 3003.203125, "slip_onset_deg": 3003.21875, "least_normal_force": 3003.234375}}, "run": {"particles": 3004, "wall_seconds": 3004.25, "threads": 3005, "attempt": 3006, "warnings": [{"field": "/run/seed", "text": "is odd"}, {"field": "/run/steps", "text": "are few"}]}}');
INSERT INTO "result" VALUES(9,'{"repose": {"method": "surface-fit", "other_methods": {}, "other_methods_standard_error_deg": {}, "angle_deg": 500.015625, "standard_error_deg": 500.03125, "minimum_deg": 500.046875, "maximum_deg": 500.0625, "steady": false, "verdict": "drifting", "drift_deg_per_revolution": 501.078125, "drift_bound_deg_per_revolution": 501.09375, "interface_fluctuation": 501.109375, "window": {"start": 501.125, "end": 501.140625, "revolutions": 501.15625, "correlation_times": 501.171875}, "correlation_time": 501.1875, "frames": 502, "layers": 502.203125, "slumps": {"count": 503, "period": 503.21875, "period_standard_error": 503.234375, "start_deg": 503.25, "start_standard_error_deg": 503.265625, "stop_deg": 503.28125, "stop_standard_error_deg": 503.296875, "size_deg": 503.3125, "size_standard_error_deg": 503.328125}}, "regime": {"name": "slumping", "certain": true, "omega2_outer": 504.34375, "omega2_inner": 504.359375, "predicted": {"stationary_eq33": 504.375, "sliding_eq35": 504.390625, "sliding_eq36": 504.40625}, "evidence": {"wall_slip": 504.421875, "wall_slip_fluctuation": 504.4375, "angle_fluctuation_deg": 504.453125, "flow_fluctuation": 504.46875, "airborne_fraction": 504.484375, "wall_coverage": 504.5, "curvature_deg": 504.515625, "fallen_fraction": 504.53125, "surface_lag": 504.546875}}, "segregation": {"radial_index": 504.5625, "axial_index": 504.578125, "lacey_index": 504.59375}, "packing": {"solid_fraction": 504.609375, "coordination_number": 504.625, "mean_overlap": 504.640625, "overlap_99": 504.65625}, "drive": {"torque": 504.671875, "torque_standard_error": 504.6875, "weight_torque": 504.703125, "weight_torque_standard_error": 504.71875, "torque_number": 504.734375, "power": 504.75}, "run": {"particles": 505, "spheres": 506, "steps": 507, "time_step": 507.765625, "simulated_seconds": 507.78125, "settling_seconds": 507.796875, "wall_seconds": 507.8125, "particle_steps_per_second": 507.828125, "maximum_overlap": 507.84375, "stiffness": 507.859375, "fill_fraction": 507.875, "samples": 508, "snapshots": 509, "threads": 510, "isa": "avx2", "precision": "double", "seed": 511, "ended_by": "duration", "attempt": 512, "warnings": [{"field": "/run/seed", "text": "is odd"}, {"field": "/run/steps", "text": "are few"}]}}');
INSERT INTO "result" VALUES(10,'{"repose": {"method": "surface-fit", "other_methods": {}, "other_methods_standard_error_deg": {}, "angle_deg": 700.015625, "standard_error_deg": 700.03125, "minimum_deg": 700.046875, "maximum_deg": 700.0625, "steady": false, "verdict": "drifting", "drift_deg_per_revolution": 701.078125, "drift_bound_deg_per_revolution": 701.09375, "interface_fluctuation": 701.109375, "window": {"start": 701.125, "end": 701.140625, "revolutions": 701.15625, "correlation_times": 701.171875}, "correlation_time": 701.1875, "frames": 702, "layers": 702.203125, "slumps": {"count": 703, "period": 703.21875, "period_standard_error": 703.234375, "start_deg": 703.25, "start_standard_error_deg": 703.265625, "stop_deg": 703.28125, "stop_standard_error_deg": 703.296875, "size_deg": 703.3125, "size_standard_error_deg": 703.328125}}, "regime": {"name": "slumping", "certain": true, "omega2_outer": 704.34375, "omega2_inner": 704.359375, "predicted": {"stationary_eq33": 704.375, "sliding_eq35": 704.390625, "sliding_eq36": 704.40625}, "evidence": {"wall_slip": 704.421875, "wall_slip_fluctuation": 704.4375, "angle_fluctuation_deg": 704.453125, "flow_fluctuation": 704.46875, "airborne_fraction": 704.484375, "wall_coverage": 704.5, "curvature_deg": 704.515625, "fallen_fraction": 704.53125, "surface_lag": 704.546875}}, "segregation": {"radial_index": 704.5625, "axial_index": 704.578125, "lacey_index": 704.59375}, "packing": {"solid_fraction": 704.609375, "coordination_number": 704.625, "mean_overlap": 704.640625, "overlap_99": 704.65625}, "drive": {"torque": 704.671875, "torque_standard_error": 704.6875, "weight_torque": 704.703125, "weight_torque_standard_error": 704.71875, "torque_number": 704.734375, "power": 704.75}, "run": {"particles": 705, "spheres": 706, "steps": 707, "time_step": 707.765625, "simulated_seconds": 707.78125, "settling_seconds": 707.796875, "wall_seconds": 707.8125, "particle_steps_per_second": 707.828125, "maximum_overlap": 707.84375, "stiffness": 707.859375, "fill_fraction": 707.875, "samples": 708, "snapshots": 709, "threads": 710, "isa": "avx2", "precision": "double", "seed": 711, "ended_by": "duration", "attempt": 712, "warnings": [{"field": "/run/seed", "text": "is odd"}, {"field": "/run/steps", "text": "are few"}]}}');
INSERT INTO "result" VALUES(11,'{"repose": {"method": "surface-fit", "other_methods": {}, "other_methods_standard_error_deg": {}, "angle_deg": 500.015625, "standard_error_deg": 500.03125, "minimum_deg": 500.046875, "maximum_deg": 500.0625, "steady": false, "verdict": "drifting", "drift_deg_per_revolution": 501.078125, "drift_bound_deg_per_revolution": 501.09375, "interface_fluctuation": 501.109375, "window": {"start": 501.125, "end": 501.140625, "revolutions": 501.15625, "correlation_times": 501.171875}, "correlation_time": 501.1875, "frames": 502, "layers": 502.203125, "slumps": {"count": 503, "period": 503.21875, "period_standard_error": 503.234375, "start_deg": 503.25, "start_standard_error_deg": 503.265625, "stop_deg": 503.28125, "stop_standard_error_deg": 503.296875, "size_deg": 503.3125, "size_standard_error_deg": 503.328125}}, "regime": {"name": "slumping", "certain": true, "omega2_outer": 504.34375, "omega2_inner": 504.359375, "predicted": {"stationary_eq33": 504.375, "sliding_eq35": 504.390625, "sliding_eq36": 504.40625}, "evidence": {"wall_slip": 504.421875, "wall_slip_fluctuation": 504.4375, "angle_fluctuation_deg": 504.453125, "flow_fluctuation": 504.46875, "airborne_fraction": 504.484375, "wall_coverage": 504.5, "curvature_deg": 504.515625, "fallen_fraction": 504.53125, "surface_lag": 504.546875}}, "segregation": {"radial_index": 504.5625, "axial_index": 504.578125, "lacey_index": 504.59375}, "packing": {"solid_fraction": 504.609375, "coordination_number": 504.625, "mean_overlap": 504.640625, "overlap_99": 504.65625}, "drive": {"torque": 504.671875, "torque_standard_error": 504.6875, "weight_torque": 504.703125, "weight_torque_standard_error": 504.71875, "torque_number": 504.734375, "power": 504.75}, "run": {"particles": 505, "spheres": 506, "steps": 507, "time_step": 507.765625, "simulated_seconds": 507.78125, "settling_seconds": 507.796875, "wall_seconds": 507.8125, "particle_steps_per_second": 507.828125, "maximum_overlap": 507.84375, "stiffness": 507.859375, "fill_fraction": 507.875, "samples": 508, "snapshots": 509, "threads": 510, "isa": "avx2", "precision": "double", "seed": 511, "ended_by": "duration", "attempt": 512, "warnings": [{"field": "/run/seed", "text": "is odd"}, {"field": "/run/steps", "text": "are few"}]}}');
INSERT INTO "result" VALUES(12,'{"repose": {"method": "surface-fit", "other_methods": {}, "other_methods_standard_error_deg": {}, "angle_deg": 700.015625, "standard_error_deg": 700.03125, "minimum_deg": 700.046875, "maximum_deg": 700.0625, "steady": false, "verdict": "drifting", "drift_deg_per_revolution": 701.078125, "drift_bound_deg_per_revolution": 701.09375, "interface_fluctuation": 701.109375, "window": {"start": 701.125, "end": 701.140625, "revolutions": 701.15625, "correlation_times": 701.171875}, "correlation_time": 701.1875, "frames": 702, "layers": 702.203125, "slumps": {"count": 703, "period": 703.21875, "period_standard_error": 703.234375, "start_deg": 703.25, "start_standard_error_deg": 703.265625, "stop_deg": 703.28125, "stop_standard_error_deg": 703.296875, "size_deg": 703.3125, "size_standard_error_deg": 703.328125}}, "regime": {"name": "slumping", "certain": true, "omega2_outer": 704.34375, "omega2_inner": 704.359375, "predicted": {"stationary_eq33": 704.375, "sliding_eq35": 704.390625, "sliding_eq36": 704.40625}, "evidence": {"wall_slip": 704.421875, "wall_slip_fluctuation": 704.4375, "angle_fluctuation_deg": 704.453125, "flow_fluctuation": 704.46875, "airborne_fraction": 704.484375, "wall_coverage": 704.5, "curvature_deg": 704.515625, "fallen_fraction": 704.53125, "surface_lag": 704.546875}}, "segregation": {"radial_index": 704.5625, "axial_index": 704.578125, "lacey_index": 704.59375}, "packing": {"solid_fraction": 704.609375, "coordination_number": 704.625, "mean_overlap": 704.640625, "overlap_99": 704.65625}, "drive": {"torque": 704.671875, "torque_standard_error": 704.6875, "weight_torque": 704.703125, "weight_torque_standard_error": 704.71875, "torque_number": 704.734375, "power": 704.75}, "run": {"particles": 705, "spheres": 706, "steps": 707, "time_step": 707.765625, "simulated_seconds": 707.78125, "settling_seconds": 707.796875, "wall_seconds": 707.8125, "particle_steps_per_second": 707.828125, "maximum_overlap": 707.84375, "stiffness": 707.859375, "fill_fraction": 707.875, "samples": 708, "snapshots": 709, "threads": 710, "isa": "avx2", "precision": "double", "seed": 711, "ended_by": "duration", "attempt": 712, "warnings": [{"field": "/run/seed", "text": "is odd"}, {"field": "/run/steps", "text": "are few"}]}}');
CREATE TABLE run_result(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  particles INTEGER, steps INTEGER, time_step REAL, simulated_seconds REAL, wall_seconds REAL,  particle_steps_per_second REAL, maximum_overlap REAL, threads INTEGER, seed INTEGER, warnings INTEGER) STRICT;
INSERT INTO "run_result" VALUES(1,81,12057,5.08375315348017905135e-05,3.99989698115820468959e-01,3.7978258800103503745e-01,2.57151599587640492254e+06,0.0384879513058015,1,7,0);
INSERT INTO "run_result" VALUES(2,120,39389,1.77715317526334620618e-05,7.00002864204479435805e-01,4.14572813999257050454e-01,1.14013264748432599005e+07,4.41468016056000417401e-02,1,3,0);
INSERT INTO "run_result" VALUES(3,240,25882,2.56474042317623652977e-05,4.50009354650502457761e-01,7.30641059999470598995e-01,8.50168480813889764283e+06,3.36904968310973579326e-02,1,5,0);
INSERT INTO "run_result" VALUES(4,1,NULL,NULL,NULL,1.12662350002210587263e-02,NULL,NULL,1,NULL,0);
INSERT INTO "run_result" VALUES(5,105,107,107.765625,107.78125,107.8125,107.828125,107.84375,110,111,2);
INSERT INTO "run_result" VALUES(6,1006,1008,1008.21875,1008.234375,1008.265625,1008.28125,1008.296875,1011,1012,2);
INSERT INTO "run_result" VALUES(7,2006,2008,2008.171875,2008.1875,2008.21875,2008.234375,2008.25,2011,2012,2);
INSERT INTO "run_result" VALUES(8,3004,NULL,NULL,NULL,3004.25,NULL,NULL,3005,NULL,2);
INSERT INTO "run_result" VALUES(9,505,507,507.765625,507.78125,507.8125,507.828125,507.84375,510,511,2);
INSERT INTO "run_result" VALUES(10,705,707,707.765625,707.78125,707.8125,707.828125,707.84375,710,711,2);
INSERT INTO "run_result" VALUES(11,505,507,507.765625,507.78125,507.8125,507.828125,507.84375,510,511,2);
INSERT INTO "run_result" VALUES(12,705,707,707.765625,707.78125,707.8125,707.828125,707.84375,710,711,2);
CREATE TABLE sample(  job INTEGER NOT NULL REFERENCES job(number) ON DELETE CASCADE,  number INTEGER NOT NULL, step INTEGER NOT NULL, time REAL NOT NULL,  measures TEXT NOT NULL,  angle_deg REAL GENERATED ALWAYS AS (measures->>'angle_deg') VIRTUAL,  PRIMARY KEY(job, number)) STRICT, WITHOUT ROWID;
INSERT INTO "sample" VALUES(1,0,4189,0.0,'{"time":0.0,"angle_deg":1.04887985361,"center_of_mass_deg":-1.30001624964,"theil_sen_deg":6.97354892582,"upper_chord_deg":0.401996775211,"lower_chord_deg":-1.48328350226,"chord_deg":2.72099030497,"solid_fraction":0.565735654294,"coordination_number":4.64197530864,"airborne_fraction":0.0,"wall_slip":null,"wall_coverage":0.333333333333,"flow_speed":0.000312642533673,"surface_lag":null,"kinetic_energy":1.92900167644e-8,"radial_index":null,"torque":null,"weight_torque":-1.36482107125e-5,"mean_overlap":0.00237894649122,"overlap_99":0.0075450703654}');
INSERT INTO "sample" VALUES(1,1,5173,0.0500241310302,'{"time":0.0500241310302,"angle_deg":13.0202142723,"center_of_mass_deg":12.0293382089,"theil_sen_deg":16.9656959463,"upper_chord_deg":9.05492209851,"lower_chord_deg":14.4691219643,"chord_deg":12.9966116789,"solid_fraction":0.587200454494,"coordination_number":4.18518518519,"airborne_fraction":0.0,"wall_slip":null,"wall_coverage":0.305555555556,"flow_speed":0.0,"surface_lag":0.903143504204,"kinetic_energy":2.17515414991e-5,"radial_index":null,"torque":0.000178854125549,"weight_torque":0.000130054418203,"mean_overlap":0.00228195272444,"overlap_99":0.00792561493184}');
INSERT INTO "sample" VALUES(1,2,6156,0.099997424529,'{"time":0.099997424529,"angle_deg":29.3490841358,"center_of_mass_deg":28.0616004642,"theil_sen_deg":32.3697892404,"upper_chord_deg":21.8780318488,"lower_chord_deg":33.7666886817,"chord_deg":35.3702870775,"solid_fraction":0.582860056078,"coordination_number":4.3950617284,"airborne_fraction":0.0,"wall_slip":null,"wall_coverage":0.305555555556,"flow_speed":0.0,"surface_lag":0.524280281897,"kinetic_energy":2.02501784108e-5,"radial_index":null,"torque":0.000208807765647,"weight_torque":0.000294490027818,"mean_overlap":0.00220215362058,"overlap_99":0.00698002768228}');
INSERT INTO "sample" VALUES(1,3,7140,0.150021555559,'{"time":0.150021555559,"angle_deg":41.1139410231,"center_of_mass_deg":40.400089827,"theil_sen_deg":42.7047581614,"upper_chord_deg":28.8137870656,"lower_chord_deg":51.5245117205,"chord_deg":49.5135587247,"solid_fraction":0.57619007348,"coordination_number":3.46913580247,"airborne_fraction":0.0,"wall_slip":null,"wall_coverage":0.305555555556,"flow_speed":0.0100563018204,"surface_lag":0.625512644404,"kinetic_energy":1.3863492538e-5,"radial_index":null,"torque":0.000303209510249,"weight_torque":0.000402512178037,"mean_overlap":0.00229863674959,"overlap_99":0.00744848072401}');
INSERT INTO "sample" VALUES(1,4,8123,0.199994849058,'{"time":0.199994849058,"angle_deg":39.8893233829,"center_of_mass_deg":41.8753117994,"theil_sen_deg":31.8040448755,"upper_chord_deg":36.2050271534,"lower_chord_deg":56.7137727377,"chord_deg":39.5847018944,"solid_fraction":0.551251433353,"coordination_number":2.08641975309,"airborne_fraction":0.0,"wall_slip":null,"wall_coverage":0.222222222222,"flow_speed":0.0421280524221,"surface_lag":1.40329622262,"kinetic_energy":2.11347036251e-5,"radial_index":null,"torque":0.000334775725182,"weight_torque":0.000406825632145,"mean_overlap":0.00244458256168,"overlap_99":0.00977036804778}');
INSERT INTO "sample" VALUES(1,5,9107,0.250018980088,'{"time":0.250018980088,"angle_deg":26.0122787919,"center_of_mass_deg":32.0525995713,"theil_sen_deg":33.6848087035,"upper_chord_deg":38.6176186298,"lower_chord_deg":20.6610753906,"chord_deg":14.6680974214,"solid_fraction":0.547716809146,"coordination_number":2.45679012346,"airborne_fraction":0.0,"wall_slip":null,"wall_coverage":0.194444444444,"flow_speed":0.0308173730155,"surface_lag":2.35827793263,"kinetic_energy":3.43583280358e-5,"radial_index":null,"torque":0.00036923676903,"weight_torque":0.000331625080894,"mean_overlap":0.00385634026678,"overlap_99":0.0111089073993}');
INSERT INTO "sample" VALUES(1,6,10090,0.299992273587,'{"time":0.299992273587,"angle_deg":20.2366926041,"center_of_mass_deg":27.5654406768,"theil_sen_deg":12.788621457,"upper_chord_deg":20.2124359703,"lower_chord_deg":22.6637491684,"chord_deg":13.0071797041,"solid_fraction":0.569434046047,"coordination_number":2.83950617284,"airborne_fraction":0.0,"wall_slip":null,"wall_coverage":0.25,"flow_speed":0.0315187576549,"surface_lag":2.97908261347,"kinetic_energy":1.66366318438e-5,"radial_index":null,"torque":0.000333700681616,"weight_torque":0.000290672900511,"mean_overlap":0.00257340741359,"overlap_99":0.00970232616355}');
INSERT INTO "sample" VALUES(1,7,11074,0.350016404617,'{"time":0.350016404617,"angle_deg":29.7367533488,"center_of_mass_deg":29.6538396757,"theil_sen_deg":30.8541882356,"upper_chord_deg":35.6574126566,"lower_chord_deg":30.9455110977,"chord_deg":22.8313051151,"solid_fraction":0.580876675609,"coordination_number":4.16049382716,"airborne_fraction":0.0,"wall_slip":null,"wall_coverage":0.222222222222,"flow_speed":0.00453179388204,"surface_lag":3.26408721153,"kinetic_energy":1.69847276334e-5,"radial_index":null,"torque":0.0003397484397,"weight_torque":0.00031275061113,"mean_overlap":0.00244797251994,"overlap_99":0.010037507039}');
INSERT INTO "sample" VALUES(1,8,12057,0.399989698116,'{"time":0.399989698116,"angle_deg":35.0971568864,"center_of_mass_deg":36.2618782395,"theil_sen_deg":34.0676691995,"upper_chord_deg":35.8147891657,"lower_chord_deg":34.7046682318,"chord_deg":37.7951969515,"solid_fraction":0.571706974471,"coordination_number":3.48148148148,"airborne_fraction":0.0,"wall_slip":null,"wall_coverage":0.236111111111,"flow_speed":0.00499601746056,"surface_lag":3.32361155075,"kinetic_energy":1.66792636509e-5,"radial_index":null,"torque":0.000337732085108,"weight_torque":0.000373020692383,"mean_overlap":0.00205712609232,"overlap_99":0.00892684176585}');
INSERT INTO "sample" VALUES(2,0,0,0.0,'{"time":0.0,"angle_deg":null,"center_to_wall_deg":null,"area_fit_deg":null,"height":0.0,"coordination_number":null,"entered":1.0,"in_flight":1.0,"kinetic_energy":1.71871758857e-5,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,1,2813,0.0499913188202,'{"time":0.0499913188202,"angle_deg":null,"center_to_wall_deg":null,"area_fit_deg":null,"height":0.000158927915984,"coordination_number":0.0,"entered":15.0,"in_flight":13.0,"kinetic_energy":0.000250149833913,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,2,5627,0.100000409172,'{"time":0.100000409172,"angle_deg":null,"center_to_wall_deg":null,"area_fit_deg":null,"height":0.000950012307186,"coordination_number":0.181818181818,"entered":31.0,"in_flight":20.0,"kinetic_energy":0.000273371654006,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,3,8440,0.149991727992,'{"time":0.149991727992,"angle_deg":null,"center_to_wall_deg":null,"area_fit_deg":null,"height":0.00313481883574,"coordination_number":0.137931034483,"entered":45.0,"in_flight":16.0,"kinetic_energy":0.000274207874509,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,4,11254,0.200000818344,'{"time":0.200000818344,"angle_deg":null,"center_to_wall_deg":null,"area_fit_deg":null,"height":0.00375023690856,"coordination_number":0.0975609756098,"entered":61.0,"in_flight":20.0,"kinetic_energy":0.000251804980671,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,5,14067,0.249992137164,'{"time":0.249992137164,"angle_deg":null,"center_to_wall_deg":null,"area_fit_deg":null,"height":0.00581237803323,"coordination_number":0.31884057971,"entered":75.0,"in_flight":6.0,"kinetic_energy":0.000215485709549,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,6,16881,0.300001227516,'{"time":0.300001227516,"angle_deg":null,"center_to_wall_deg":null,"area_fit_deg":null,"height":0.00621552779718,"coordination_number":0.936708860759,"entered":91.0,"in_flight":12.0,"kinetic_energy":0.000222777527366,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,7,19694,0.349992546336,'{"time":0.349992546336,"angle_deg":null,"center_to_wall_deg":null,"area_fit_deg":null,"height":0.00798205664545,"coordination_number":1.43434343434,"entered":105.0,"in_flight":6.0,"kinetic_energy":0.000173311683546,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,8,22508,0.400001636688,'{"time":0.400001636688,"angle_deg":21.1161006942,"center_to_wall_deg":25.8470913043,"area_fit_deg":21.4925225093,"height":0.00926088398847,"coordination_number":1.61739130435,"entered":120.0,"in_flight":5.0,"kinetic_energy":0.000164817098721,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,9,25321,0.449992955508,'{"time":0.449992955508,"angle_deg":8.62259959703,"center_to_wall_deg":2.32258689826,"area_fit_deg":6.3136255411,"height":0.00920611992609,"coordination_number":3.3781512605,"entered":120.0,"in_flight":1.0,"kinetic_energy":6.66350614675e-6,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,10,28135,0.50000204586,'{"time":0.50000204586,"angle_deg":3.35030062253,"center_to_wall_deg":1.28094122297,"area_fit_deg":2.02025818035,"height":0.00914114596444,"coordination_number":4.51666666667,"entered":120.0,"in_flight":0.0,"kinetic_energy":7.29685195338e-7,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,11,30948,0.549993364681,'{"time":0.549993364681,"angle_deg":3.68394310616,"center_to_wall_deg":0.462499282279,"area_fit_deg":1.79317434306,"height":0.00909183652468,"coordination_number":4.675,"entered":120.0,"in_flight":0.0,"kinetic_energy":9.01446916285e-7,"at_rest":0.0}');
INSERT INTO "sample" VALUES(2,12,33762,0.600002455032,'{"time":0.600002455032,"angle_deg":3.75482286158,"center_to_wall_deg":0.712718472547,"area_fit_deg":2.07085913275,"height":0.00903030280833,"coordination_number":4.58333333333,"entered":120.0,"in_flight":0.0,"kinetic_energy":1.02690278889e-8,"at_rest":1.0}');
INSERT INTO "sample" VALUES(2,13,36575,0.649993773853,'{"time":0.649993773853,"angle_deg":3.85901262467,"center_to_wall_deg":0.72804099491,"area_fit_deg":2.12478423826,"height":0.00902602447305,"coordination_number":4.675,"entered":120.0,"in_flight":0.0,"kinetic_energy":2.75594162965e-11,"at_rest":1.0}');
INSERT INTO "sample" VALUES(2,14,39389,0.700002864204,'{"time":0.700002864204,"angle_deg":3.8589752305,"center_to_wall_deg":0.728062831819,"area_fit_deg":2.12476824841,"height":0.00902602004892,"coordination_number":4.675,"entered":120.0,"in_flight":0.0,"kinetic_energy":2.28846159556e-12,"at_rest":1.0}');
INSERT INTO "sample" VALUES(3,0,8336,0.0,'{"time":0.0,"angle_deg":null,"apex_to_base_deg":61.2442700668,"equal_volume_cone_deg":73.9268731434,"silhouette_deg":75.3220376852,"height":0.0222738610023,"base_diameter":0.02279927599,"coordination_number":4.53813559322,"lost":0.0,"kinetic_energy":1.44981199069e-8,"tube_height":0.0,"at_rest":1.0}');
INSERT INTO "sample" VALUES(3,1,10286,0.0500124382519,'{"time":0.0500124382519,"angle_deg":null,"apex_to_base_deg":59.8987759762,"equal_volume_cone_deg":72.5847819098,"silhouette_deg":71.9663669313,"height":0.021204125651,"base_diameter":0.0228453591691,"coordination_number":3.54460093897,"lost":0.0,"kinetic_energy":1.96964121426e-5,"tube_height":0.00500124382519,"at_rest":0.0}');
INSERT INTO "sample" VALUES(3,2,12235,0.0999992290996,'{"time":0.0999992290996,"angle_deg":null,"apex_to_base_deg":54.9538197332,"equal_volume_cone_deg":61.2825394518,"silhouette_deg":54.6832584564,"height":0.0188604506771,"base_diameter":0.0244012713283,"coordination_number":2.64864864865,"lost":0.0,"kinetic_energy":9.13378322922e-5,"tube_height":0.00999992290996,"at_rest":0.0}');
INSERT INTO "sample" VALUES(3,3,14185,0.150011667352,'{"time":0.150011667352,"angle_deg":null,"apex_to_base_deg":25.8457970678,"equal_volume_cone_deg":15.1781889219,"silhouette_deg":25.7451466855,"height":0.00967155400112,"base_diameter":0.0345708062088,"coordination_number":2.76811594203,"lost":0.0,"kinetic_energy":6.68470680071e-5,"tube_height":0.0150011667352,"at_rest":0.0}');
INSERT INTO "sample" VALUES(3,4,16134,0.199998458199,'{"time":0.199998458199,"angle_deg":14.0200472253,"apex_to_base_deg":17.4357309261,"equal_volume_cone_deg":14.9563728152,"silhouette_deg":23.1021084496,"height":0.00778132009598,"base_diameter":0.04,"coordination_number":3.46,"lost":1.0,"kinetic_energy":1.53410353319e-5,"tube_height":0.0199998458199,"at_rest":0.0}');
INSERT INTO "sample" VALUES(3,5,18084,0.250010896451,'{"time":0.250010896451,"angle_deg":null,"apex_to_base_deg":18.1566201057,"equal_volume_cone_deg":17.2090975464,"silhouette_deg":23.782951943,"height":0.00801934271906,"base_diameter":0.039776988171,"coordination_number":3.98130841121,"lost":11.0,"kinetic_energy":4.69405881955e-6,"tube_height":0.0250010896451,"at_rest":0.0}');
INSERT INTO "sample" VALUES(3,6,20033,0.299997687299,'{"time":0.299997687299,"angle_deg":20.7301404349,"apex_to_base_deg":18.1647659955,"equal_volume_cone_deg":17.7868720408,"silhouette_deg":24.1433712934,"height":0.00798575641679,"base_diameter":0.0395668238573,"coordination_number":4.133640553,"lost":15.0,"kinetic_energy":1.07783903368e-7,"tube_height":0.0299997687299,"at_rest":0.0}');
INSERT INTO "sample" VALUES(3,7,21983,0.350010125551,'{"time":0.350010125551,"angle_deg":22.1747102188,"apex_to_base_deg":18.1800960561,"equal_volume_cone_deg":18.0530560424,"silhouette_deg":24.1994598709,"height":0.0079882706795,"base_diameter":0.0395491659982,"coordination_number":4.20547945205,"lost":15.0,"kinetic_energy":2.17957693036e-8,"tube_height":0.0350010125551,"at_rest":1.0}');
INSERT INTO "sample" VALUES(3,8,23932,0.399996916399,'{"time":0.399996916399,"angle_deg":22.1103516356,"apex_to_base_deg":18.3777130105,"equal_volume_cone_deg":18.4617694866,"silhouette_deg":24.184863336,"height":0.00798835601261,"base_diameter":0.0391470462585,"coordination_number":4.2247706422,"lost":15.0,"kinetic_energy":9.00330485117e-10,"tube_height":0.0399996916399,"at_rest":1.0}');
INSERT INTO "sample" VALUES(3,9,25882,0.450009354651,'{"time":0.450009354651,"angle_deg":21.9737011624,"apex_to_base_deg":18.3776631121,"equal_volume_cone_deg":18.4335923097,"silhouette_deg":24.1834482245,"height":0.00798831122765,"base_diameter":0.0391469253514,"coordination_number":4.20276497696,"lost":15.0,"kinetic_energy":6.07967169396e-10,"tube_height":0.0450009354651,"at_rest":1.0}');
INSERT INTO "sample" VALUES(5,0,0,0.0,'{"angle_deg":112.875,"wall_slip":null}');
INSERT INTO "sample" VALUES(5,1,100,0.125,'{"angle_deg":113.125,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(5,2,200,0.25,'{"angle_deg":113.375,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(6,0,0,0.0,'{"angle_deg":1013.3125,"wall_slip":null}');
INSERT INTO "sample" VALUES(6,1,100,0.125,'{"angle_deg":1013.5625,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(6,2,200,0.25,'{"angle_deg":1013.8125,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(7,0,0,0.0,'{"angle_deg":2013.265625,"wall_slip":null}');
INSERT INTO "sample" VALUES(7,1,100,0.125,'{"angle_deg":2013.515625,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(7,2,200,0.25,'{"angle_deg":2013.765625,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(8,0,0,0.0,'{"angle_deg":3006.25,"wall_slip":null}');
INSERT INTO "sample" VALUES(8,1,100,0.125,'{"angle_deg":3006.5,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(8,2,200,0.25,'{"angle_deg":3006.75,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(9,0,0,0.0,'{"angle_deg":512.875,"wall_slip":null}');
INSERT INTO "sample" VALUES(9,1,100,0.125,'{"angle_deg":513.125,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(9,2,200,0.25,'{"angle_deg":513.375,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(10,0,0,0.0,'{"angle_deg":712.875,"wall_slip":null}');
INSERT INTO "sample" VALUES(10,1,100,0.125,'{"angle_deg":713.125,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(10,2,200,0.25,'{"angle_deg":713.375,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(11,0,0,0.0,'{"angle_deg":512.875,"wall_slip":null}');
INSERT INTO "sample" VALUES(11,1,100,0.125,'{"angle_deg":513.125,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(11,2,200,0.25,'{"angle_deg":513.375,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(12,0,0,0.0,'{"angle_deg":712.875,"wall_slip":null}');
INSERT INTO "sample" VALUES(12,1,100,0.125,'{"angle_deg":713.125,"wall_slip":0.5}');
INSERT INTO "sample" VALUES(12,2,200,0.25,'{"angle_deg":713.375,"wall_slip":0.5}');
CREATE TABLE segregation_result(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  radial_index REAL, axial_index REAL, lacey_index REAL) STRICT;
INSERT INTO "segregation_result" VALUES(1,NULL,NULL,NULL);
INSERT INTO "segregation_result" VALUES(5,104.5625,104.578125,104.59375);
INSERT INTO "segregation_result" VALUES(9,504.5625,504.578125,504.59375);
INSERT INTO "segregation_result" VALUES(10,704.5625,704.578125,704.59375);
INSERT INTO "segregation_result" VALUES(11,504.5625,504.578125,504.59375);
INSERT INTO "segregation_result" VALUES(12,704.5625,704.578125,704.59375);
CREATE TABLE snapshot(  job INTEGER NOT NULL REFERENCES job(number) ON DELETE CASCADE,  number INTEGER NOT NULL, step INTEGER NOT NULL, time REAL NOT NULL,  file TEXT NOT NULL, bytes INTEGER NOT NULL, particles INTEGER NOT NULL,  PRIMARY KEY(job, number)) STRICT, WITHOUT ROWID;
INSERT INTO "snapshot" VALUES(1,0,12057,0.399989698116,'000000.hdf',44487,81);
INSERT INTO "snapshot" VALUES(2,0,39389,0.700002864204,'000000.hdf',46447,120);
INSERT INTO "snapshot" VALUES(3,0,25882,0.450009354651,'000000.hdf',52413,240);
INSERT INTO "snapshot" VALUES(5,0,0,0.25,'000000.hdf',111,41);
INSERT INTO "snapshot" VALUES(6,0,0,0.25,'000000.hdf',111,41);
INSERT INTO "snapshot" VALUES(7,0,0,0.25,'000000.hdf',111,41);
INSERT INTO "snapshot" VALUES(8,0,0,0.25,'000000.hdf',111,41);
INSERT INTO "snapshot" VALUES(9,0,0,0.25,'000000.hdf',111,41);
INSERT INTO "snapshot" VALUES(10,0,0,0.25,'000000.hdf',111,41);
INSERT INTO "snapshot" VALUES(11,0,0,0.25,'000000.hdf',111,41);
INSERT INTO "snapshot" VALUES(12,0,0,0.25,'000000.hdf',111,41);
CREATE TABLE study(  number INTEGER PRIMARY KEY,  id TEXT NOT NULL UNIQUE,  process TEXT NOT NULL,  name TEXT NOT NULL,  document TEXT NOT NULL,  cases INTEGER NOT NULL, repeats INTEGER NOT NULL, jobs INTEGER NOT NULL,  estimated_seconds REAL NOT NULL,  created TEXT NOT NULL, started TEXT, updated TEXT NOT NULL,  accepted INTEGER NOT NULL DEFAULT 0, running INTEGER NOT NULL DEFAULT 0, successful INTEGER NOT NULL DEFAULT 0,  failed INTEGER NOT NULL DEFAULT 0, dismissed INTEGER NOT NULL DEFAULT 0) STRICT;
INSERT INTO "study" VALUES(1,'20261130-014942-6f825b88','drum','friction of a drum','{
  "name": "friction of a drum",
  "base": {
    "inputs": {
      "drum": {
        "diameter": 0.050000000000000003,
        "length": 0.02,
        "ends": "walls",
        "rotation_rate_rpm": -50.0,
        "lifters": {
          "count": 4,
          "height": 0.0030000000000000001,
          "width": 0.002
        }
      },
      "particles": [
        {
          "shape": "dumbbell",
          "diameter": 0.0030000000000000001,
          "density": 1900.0,
          "share": 0.75
        },
        {
          "diameter": 0.0040000000000000001,
          "share": 0.25
        }
      ],
      "particle_count": 60,
      "gravity": 3.7000000000000002,
      "contact": {
        "friction": 0.45000000000000001,
        "rolling_friction": 0.02,
        "restitution": 0.59999999999999998,
        "tangential_stiffness_ratio": 0.69999999999999996,
        "stiffness": 900.0
      },
      "wall": {
        "friction": 0.34999999999999998,
        "rolling_friction": 0.029999999999999999
      },
      "duration": {
        "revolutions": 0.5
      },
      "seed": 11,
      "threads": 1
    },
    "label": {
      "made": 500
    }
  },
  "repeats": 2,
  "cases": [
    {
      "name": "smooth",
      "inputs": {
        "contact": {
          "friction": 0.10000000000000001
        }
      },
      "label": {
        "made": 500
      }
    },
    {
      "name": "rough",
      "inputs": {
        "contact": {
          "friction": 0.59999999999999998
        }
      },
      "label": {
        "made": 700
      }
    }
  ]
}',2,2,4,2.41767139281621279423e+00,'2026-11-30T01:49:42.576Z','2026-11-30T01:49:49.362Z','2026-11-30T01:49:51.824Z',0,0,4,0,0);
CREATE TABLE study_case(  study INTEGER NOT NULL REFERENCES study(number) ON DELETE CASCADE,  position INTEGER NOT NULL,  name TEXT NOT NULL,  inputs TEXT NOT NULL,  label TEXT NOT NULL,  PRIMARY KEY(study, position)) STRICT, WITHOUT ROWID;
INSERT INTO "study_case" VALUES(1,0,'smooth','{"contact/friction":0.1}','{"made":500,"study":"friction of a drum","case":"smooth"}');
INSERT INTO "study_case" VALUES(1,1,'rough','{"contact/friction":0.6}','{"made":700,"study":"friction of a drum","case":"rough"}');
CREATE TABLE study_part(  study INTEGER NOT NULL REFERENCES study(number) ON DELETE CASCADE,  number INTEGER NOT NULL, text TEXT NOT NULL,  PRIMARY KEY(study, number)) STRICT, WITHOUT ROWID;
CREATE TABLE surface_result(  job INTEGER PRIMARY KEY REFERENCES job(number) ON DELETE CASCADE,  height REAL, center_height REAL, wall_height REAL, base_diameter REAL, volume REAL, static_cohesive_index REAL) STRICT;
INSERT INTO "surface_result" VALUES(2,9.02602004892200278363e-03,0.00910860360464605,8.97419322525797383272e-03,NULL,NULL,NULL);
INSERT INTO "surface_result" VALUES(3,7.98831122765172874089e-03,NULL,NULL,3.91469253514458784271e-02,4.49277365767580697756e-06,7.91527535923991260209e-04);
INSERT INTO "surface_result" VALUES(6,1001.140625,1001.15625,1001.171875,NULL,NULL,NULL);
INSERT INTO "surface_result" VALUES(7,2001.078125,NULL,NULL,2001.09375,2001.109375,2001.125);
CREATE INDEX job_waiting ON job(number) WHERE status='accepted';
CREATE INDEX job_running ON job(number) WHERE status='running';
CREATE INDEX job_by_status ON job(status, number);
CREATE UNIQUE INDEX job_of_study ON job(study, study_case, study_repeat) WHERE study IS NOT NULL;
CREATE INDEX run_that_tells ON run_result(job) WHERE steps>0 AND wall_seconds>0.5;
CREATE INDEX job_listed ON job(study, status, process, created, started, finished, label, id);
CREATE TRIGGER job_counted AFTER INSERT ON job BEGIN  UPDATE job_count SET jobs=jobs+1 WHERE status=new.status; END;
CREATE TRIGGER job_moved AFTER UPDATE OF status ON job WHEN old.status<>new.status BEGIN  UPDATE job_count SET jobs=jobs-1 WHERE status=old.status;  UPDATE job_count SET jobs=jobs+1 WHERE status=new.status; END;
CREATE TRIGGER job_forgotten AFTER DELETE ON job BEGIN  UPDATE job_count SET jobs=jobs-1 WHERE status=old.status; END;
CREATE TRIGGER study_job_counted AFTER INSERT ON job WHEN new.study IS NOT NULL BEGIN  UPDATE study SET accepted=accepted+(new.status='accepted'), running=running+(new.status='running'),   successful=successful+(new.status='successful'), failed=failed+(new.status='failed'),   dismissed=dismissed+(new.status='dismissed') WHERE number=new.study; END;
CREATE TRIGGER study_job_moved AFTER UPDATE OF status ON job WHEN old.status<>new.status AND new.study IS NOT NULL BEGIN  UPDATE study SET accepted=accepted+(new.status='accepted')-(old.status='accepted'),   running=running+(new.status='running')-(old.status='running'),   successful=successful+(new.status='successful')-(old.status='successful'),   failed=failed+(new.status='failed')-(old.status='failed'),   dismissed=dismissed+(new.status='dismissed')-(old.status='dismissed'),   started=coalesce(started,new.started), updated=new.updated WHERE number=new.study; END;
CREATE TRIGGER study_job_forgotten AFTER DELETE ON job WHEN old.study IS NOT NULL BEGIN  UPDATE study SET jobs=jobs-1, accepted=accepted-(old.status='accepted'), running=running-(old.status='running'),   successful=successful-(old.status='successful'), failed=failed-(old.status='failed'),   dismissed=dismissed-(old.status='dismissed') WHERE number=old.study; END;
CREATE VIEW run_summary AS SELECT  job.id, job.process, job.label, job.status, job.created, job.started, job.finished, job.attempt,  i.drum_diameter, i.drum_length, i.ends, i.lifters, coalesce(i.shape, fi.shape, hi.shape) AS shape,  fi.cylinder_diameter, fi.stream_diameter, fi.rate, fi.impact_speed,  hi.tube_diameter, hi.lift_speed, hi.plate_diameter, hi.rim_height, hi.plate_friction,  coalesce(i.rotation_rate, gi.rotation_rate) AS rotation_rate,  coalesce(i.gravity, fi.gravity, hi.gravity, gi.gravity) AS gravity, i.fill_fraction, r.particles,  coalesce(i.species, fi.species, hi.species) AS species, coalesce(i.diameter, fi.diameter, hi.diameter) AS diameter,  coalesce(i.density, fi.density, hi.density) AS density,  coalesce(i.friction, fi.friction, hi.friction, gi.friction) AS friction,  coalesce(i.restitution, fi.restitution, hi.restitution) AS restitution,  coalesce(i.wall_friction, fi.wall_friction, hi.wall_friction) AS wall_friction,  coalesce(i.rolling_friction, fi.rolling_friction, hi.rolling_friction) AS rolling_friction,  coalesce(i.wall_rolling_friction, fi.wall_rolling_friction, hi.wall_rolling_friction) AS wall_rolling_friction,  coalesce(i.tangential_stiffness_ratio, fi.tangential_stiffness_ratio, hi.tangential_stiffness_ratio)   AS tangential_stiffness_ratio,  coalesce(i.stiffness, fi.stiffness, hi.stiffness) AS stiffness, i.lining_diameter,  coalesce(i.time_step, fi.time_step, hi.time_step) AS time_step,  coalesce(i.duration, fi.duration, hi.duration) AS duration, coalesce(i.seed, fi.seed, hi.seed) AS seed, gi.radius,  a.angle_deg, a.standard_error_deg, a.minimum_deg, a.maximum_deg, a.steady, a.verdict, a.drift_deg_per_revolution,  a.drift_bound_deg_per_revolution, a.layers, a.interface_fluctuation,  a.slumps_count, a.slumps_period, a.slumps_start_deg, a.slumps_stop_deg,  a.while_filling_angle_deg, a.while_filling_standard_error_deg,  f.height, f.center_height, f.wall_height, f.base_diameter, f.static_cohesive_index, hr.lost,  g.name AS regime, g.certain, g.omega2_outer, g.omega2_inner,  s.radial_index, s.axial_index, s.lacey_index, p.solid_fraction, p.coordination_number, p.mean_overlap, p.overlap_99,  d.torque, d.torque_standard_error, d.torque_number, d.power,  gr.minimum_omega2, gr.minimum_rotation_rate, gr.slip_per_revolution,  r.steps, r.simulated_seconds, r.wall_seconds, r.particle_steps_per_second, r.maximum_overlap, r.threads FROM job JOIN run_result r ON r.job=job.number LEFT JOIN drum_input i ON i.job=job.number LEFT JOIN granule_input gi ON gi.job=job.number LEFT JOIN granule_result gr ON gr.job=job.number LEFT JOIN repose_result a ON a.job=job.number LEFT JOIN regime_result g ON g.job=job.number LEFT JOIN segregation_result s ON s.job=job.number LEFT JOIN packing_result p ON p.job=job.number LEFT JOIN drive_result d ON d.job=job.number LEFT JOIN fill_input fi ON fi.job=job.number LEFT JOIN heap_input hi ON hi.job=job.number LEFT JOIN surface_result f ON f.job=job.number LEFT JOIN heap_result hr ON hr.job=job.number WHERE job.status='successful';
CREATE TRIGGER job_number_kept AFTER DELETE ON job BEGIN  UPDATE last_deleted SET number=old.number WHERE number<old.number; END;
COMMIT;
PRAGMA application_id=1919250547;
PRAGMA user_version=11;
