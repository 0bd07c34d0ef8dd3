/PROG  TOOL_OFFSET
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "";
LINE_COUNT	= 5;
TCD:  STACK_SIZE	= 0;
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:  OFFSET CONDITION PR[1]    ;
   2:J P[1] 100% FINE Offset    ;
   3:L P[2] 200mm/sec FINE Tool_Offset,PR[2]    ;
   4:L P[2] 200mm/sec FINE    ;
   5:L P[3] 200mm/sec FINE VOFFSET,VR[1]    ;
/POS
P[1]{
   GP1:
	UF : 0, UT : 1,	
	J1=    10.000 deg,	J2=   -20.000 deg,	J3=    30.000 deg,
	J4=     0.000 deg,	J5=   -45.000 deg,	J6=     5.000 deg
};
P[2]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   600.000  mm,	Y =   100.000  mm,	Z =   500.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[3]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   600.000  mm,	Y =   100.000  mm,	Z =   500.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
