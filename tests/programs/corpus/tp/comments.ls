/PROG  COMMENTS
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "";
LINE_COUNT	= 6;
TCD:  STACK_SIZE	= 0;
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:  !J P[1] 20% FINE    ;
   2:  //J P[2] 20% FINE    ;
   3:  --eg:L P[1] 10mm/sec FINE ;    ;
   4:J P[1] 20% FINE    ;
   5:  MESSAGE[J P[2] reached]    ;
   6:  ! it's done    ;
/POS
P[1]{
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
/END
