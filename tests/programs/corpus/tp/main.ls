/PROG  MAIN
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "";
LINE_COUNT	= 8;
TCD:  STACK_SIZE	= 0;
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:  UFRAME_NUM=1    ;
   2:  UTOOL_NUM=1    ;
   3:J P[1:home position] 100% FINE    ;
   4:J P[2] 50% CNT100    ;
   5:L P[3] 500mm/sec CNT50 ACC80    ;
   6:L P[3] 100mm/sec FINE Offset,PR[5]    ;
   7:  CALL GRIP(1)    ;
   8:J P[1] 100% FINE    ;
/POS
P[1:"home position"]{
   GP1:
	UF : 0, UT : 1,	
	J1=    10.000 deg,	J2=   -20.000 deg,	J3=    30.000 deg,
	J4=     0.000 deg,	J5=   -45.000 deg,	J6=     5.000 deg
};
P[2]{
   GP1:
	UF : 0, UT : 1,	
	J1=    10.000 deg,	J2=   -20.000 deg,	J3=    30.000 deg,
	J4=     0.000 deg,	J5=   -45.000 deg,	J6=     5.000 deg
};
P[3]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   600.000  mm,	Y =   100.000  mm,	Z =   500.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
